// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>

namespace coracle
{
UserError::UserError(const std::string &title,
                     const std::string &where,
                     const std::string &found,
                     const std::string &cure)
  : std::runtime_error(title + "\n  case      " + where + "\n  found     " + found +
                       "\n  cure      " + cure)
  , title(title)
  , where(where)
  , found(found)
  , cure(cure)
{}

RunFailure::RunFailure(const std::string &title, const std::string &details, const std::string &cure)
  : std::runtime_error(title + "\n  found     " + details + "\n  cure      " + cure)
  , title(title)
  , details(details)
  , cure(cure)
{}
} // namespace coracle

// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/base/parameter_values.h>

namespace coracle
{
ParameterFile::ParameterFile(const Declaration &declaration) : data(std::make_unique<Data>())
{
  data->root = declaration.data->root;
}

ParameterFile::ParameterFile() : data(std::make_unique<Data>()) {}

ParameterFile::~ParameterFile() = default;

ParameterFile::ParameterFile(ParameterFile &&) = default;

ParameterFile
ParameterFile::empty_copy() const
{
  ParameterFile result;
  result.data->root = data->root;
  return result;
}

void
ParameterFile::read(const std::string &file_name)
{
  using Lines      = std::vector<internal::Line>;
  const auto lines = [&] { return internal::read_lines(file_name); };
  data->file_name  = file_name;
  data->statements = internal::scan(dealii::Utilities::MPI::job_supports_mpi()
                                      ? mpi::on_root<Lines>(lines, MPI_COMM_WORLD)
                                      : lines());
}

void
ParameterFile::read_text(const std::string &text, const std::string &file_name)
{
  data->file_name  = file_name;
  data->statements = internal::scan(internal::split_lines(text, file_name));
}

void
ParameterFile::set(const std::string &assignment)
{
  data->statements.push_back(internal::scan_assignment(assignment));
}

Parameters
ParameterFile::parameters() const
{
  auto values       = std::make_shared<Parameters::Data>();
  values->root      = data->root;
  values->file_name = data->file_name;
  values->sections =
    internal::resolve(*data->root, internal::collect(data->statements), data->file_name);
  Parameters result;
  result.data = values;
  return result;
}
} // namespace coracle

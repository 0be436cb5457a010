// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever a parameter file holds, it is read or refused with a UserError; what was read is printed
// and read again as the same.

#include <coracle/base/parameters.h>

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

namespace
{
/// Every kind of entry and section.
void
declare(coracle::Declaration &root)
{
  root.integer("Dimension", 2, "2 or 3", 2, 3);
  root.quantity("End time", "1 s", "s", "t", "when the run ends", 0.);
  root.text("Title", "", "of the run");
  root.list("Gravity", "0, -9.81", "m/s^2", "g", "body force");
  auto &bodies = root.named_sections("Bodies", "body", "what there is");
  bodies.choice("Kind", "water", {"water", "rigid"}, "of body");
  bodies.flag("Sticky", false, "or not");
  auto &rigid = bodies.when("Kind", "rigid");
  rigid.file("File", "of the mesh");
  rigid.quantity("Density", "1000", "kg/m^3", "\\rho", "of the body", 1e-12);
  rigid.function("Velocity", "0; 0", "m/s", "of the body");
  rigid.section("Output", "of this body").integer("Interval", 1, "in steps", 1);
}

void
read_all(const coracle::Parameters &parameters)
{
  for (const auto &name : parameters.section("Bodies").section_names())
    {
      const auto body = parameters.section("Bodies").section(name);
      body.flag("Sticky");
      if (body.choice("Kind") == "rigid")
        {
          body.quantity("Density");
          body.section("Output").integer("Interval");
        }
    }
}

std::string
text_of(const coracle::Declaration &declaration, const std::string &text)
{
  coracle::ParameterFile file(declaration);
  file.read_text(text);
  read_all(file.parameters());
  return file.print();
}
} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const std::string    text(reinterpret_cast<const char *>(data), size);
  coracle::Declaration declaration;
  declare(declaration);
  std::string printed;
  try
    {
      printed = text_of(declaration, text);
    }
  catch (const coracle::UserError &)
    {
      return 0;
    }
  // What is printed is itself a parameter file with the same meaning.
  try
    {
      if (text_of(declaration, printed) != printed)
        {
          std::cerr << "printed another time, it differs:\n" << printed << std::endl;
          std::abort();
        }
    }
  catch (const coracle::UserError &error)
    {
      std::cerr << "what was printed is refused: " << error.what() << '\n' << printed << std::endl;
      std::abort();
    }
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Every mistake in a parameter file is answered by its file, line, section and cure; what is
// printed is read again with the same values.
#include <coracle/base/parameters.h>

#include "tests.h"

#include <filesystem>
#include <fstream>
#include <functional>

using namespace coracle;

void
declare(Declaration &root)
{
  root.integer("Dimension", 2, "Dimensions of space.", 2, 3);
  root.quantity("End time", "1 s", "s", "T", "End of the run.", 0);
  Declaration &bodies = root.named_sections("Bodies", "body", "What moves.");
  bodies.choice("Kind", "rigid", {"rigid", "material points"}, "What it is made of.");
  bodies.list("Velocity", "", "m/s", "v_0", "At the start.");
  Declaration &points = bodies.when("Kind", "material points");
  points.quantity("Particle spacing", "1 cm", "m", "d", "Distance of particles.", 1e-6);
  points.choice("Material", "water", {"water", "gas"}, "Constitutive model.");
  points.when("Material", "water").quantity("Density", "1000", "kg/m^3", "rho", "At rest.");
  points.when("Material", "gas").quantity("Density", "1.2", "kg/m^3", "rho", "At rest.");
  points.section("Splitting", "Of particles.").flag("Active", false, "Split where cells refine.");
  bodies.when("Kind", "rigid").quantity("Mass", "", "kg", "M", "Of the whole body", 1e-12);
  bodies.when("Kind", "rigid").file("Mesh", "Its surface.");
  bodies.function("Force", "", "N", "On its centre.");
  Declaration &output = root.section("Output", "What is written.");
  output.text("Directory", "output", "Folder of the results.");
  output.flag("Overwrite", true, "Replace what is there.");
}

/// Without the folder that the test runs in.
void
print_message(const UserError &error)
{
  std::string       text = describe(error);
  const std::string here = std::filesystem::current_path().string();
  if (const std::size_t at = text.find(here); at != std::string::npos)
    text.replace(at, here.size(), "<here>");
  deallog << text << std::endl;
}

void
refused(const std::string &text, const std::vector<std::string> &assignments = {})
{
  Declaration root;
  declare(root);
  ParameterFile file(root);
  try
    {
      file.read_text(text, "folder/case.prm");
      for (const std::string &assignment : assignments)
        file.set(assignment);
      file.parameters();
      deallog << "NOT REFUSED" << std::endl;
    }
  catch (const UserError &error)
    {
      print_message(error);
    }
}

const std::string body = "subsection Bodies\n  subsection b\n";

void
test_refused()
{
  refused("set Dimesion = 2");
  refused("\n# a comment\nset end time = 2 s");
  refused("set Kind = rigid");
  refused("subsection Outputs\nend");
  refused("set End time = 2 kg");
  refused("set End time = 2 parsec");
  refused("set End time = soon");
  refused("set End time = -1 ms");
  refused("set End time =");
  refused(body + "set Mass = 0 kg\nend\nend");
  refused("set Dimension = 4");
  refused("set Dimension = 2.5");
  refused("subsection Output\n set Overwrite = maybe\nend");
  refused(body + "set Kind = materialpoints\nend\nend");
  refused(body + "set Kind = solid dust\nend\nend");
  refused(body + "set Particle spacing = 1 mm\nend\nend");
  refused(body + "subsection Splitting\nend\nend\nend");
  refused(body + "set Velocity = 1, 2 mm/s, 3 m/s\nend\nend");
  refused(body + "set Mesh = no_such_file.msh\nend\nend");
  refused("subsection Bodies\nset Mass = 1\nend");
  refused("set Dimension = 2\nset Dimension = 3");
  refused("subsection Output\nset Directory = a\n");
  refused("end");
  refused("set Dimension 2");
  refused("setDimension = 2");
  refused("subsection a/b\nend");
  refused("include no_such_file.prm");
  refused("include /dev/zero");
  std::string deep;
  for (unsigned int i = 0; i < 40; ++i)
    deep += "subsection s\n";
  refused(deep);
  refused("", {"Output/Directroy=a"});
  refused(body + "end\nend", {"Bodies/bb/Mass=2 kg"});
  refused("", {"Dimension"});
  refused("", {"Dimension=3 # or 2"});
}

const std::string whole = "set Dimension = 3  # comment\n"
                          "subsection Bodies\n"
                          "  subsection  sea   water\n"
                          "    set Kind = material points\n"
                          "    set Particle   spacing = 5 mm\n"
                          "    set Velocity = 1, \\\n"
                          "                   -2, 3 cm/s\n"
                          "    set Force = 0; if(t < 1, 2*x, 0); z + pi\n"
                          "  end\n"
                          "  subsection ball\n"
                          "    set Mass = 2 t\n"
                          "  end\n"
                          "end\n";

void
print_values(const Parameters &parameters)
{
  deallog << "Dimension " << parameters.integer("Dimension") << ", End time "
          << parameters.quantity("End time") << ", Directory "
          << parameters.section("Output").text("Directory") << std::endl;
  const Parameters bodies = parameters.section("Bodies");
  for (const std::string &name : bodies.section_names())
    deallog << bodies.section(name).path() << ": " << bodies.section(name).choice("Kind")
            << std::endl;
  const Parameters water    = bodies.section("sea water");
  const auto       velocity = water.point<3>("Velocity");
  deallog << water.name() << ": spacing " << water.quantity("Particle spacing") << ", density "
          << water.quantity("Density") << ", set: " << water.is_set("Density") << ' '
          << water.is_set("Velocity") << ", velocity " << velocity[0] << ' ' << velocity[1] << ' '
          << velocity[2] << std::endl;
  const auto force = water.function<3>("Force", 3);
  force->set_time(0.5);
  deallog << "force " << force->value(dealii::Point<3>(1, 2, 3), 0) << ' '
          << force->value(dealii::Point<3>(1, 2, 3), 1) << ' '
          << force->value(dealii::Point<3>(1, 2, 3), 2) << std::endl;
  deallog << "mass " << bodies.section("ball").quantity("Mass") << std::endl;
}

void
expect_user_error(const std::function<void()> &function)
{
  try
    {
      function();
      deallog << "NOT REFUSED" << std::endl;
    }
  catch (const UserError &error)
    {
      print_message(error);
    }
}

void
test_accepted()
{
  Declaration root;
  declare(root);
  ParameterFile file(root);
  file.read_text(whole, "folder/case.prm");
  file.set("End time=20 ms");
  file.set("Bodies/ball/Mass=3 kg");
  const Parameters parameters = file.parameters();
  print_values(parameters);

  ParameterFile again(root);
  again.read_text(file.print());
  print_values(again.parameters());
  deallog << "printed alike: " << (again.print() == file.print()) << std::endl;
  deallog << file.print() << std::endl;

  ParameterFile defaults(root);
  defaults.read_text(file.print_defaults());
  deallog << "defaults can be read: " << defaults.parameters().quantity("End time") << std::endl;
  deallog << file.print_defaults() << std::endl;
  deallog << file.print_markdown() << std::endl;

  const Parameters water = parameters.section("Bodies").section("sea water");
  expect_user_error([&] { throw water.error("Density", "title", "found\nmore", "cure"); });
  expect_user_error([&] { throw water.error("Particle spacing", "title", "found", "cure"); });
  expect_user_error([&] { throw water.error("", "title", "found", "cure"); });
  expect_user_error(
    [&] { throw parameters.section("Output").error("", "title", "found", "cure"); });
  expect_user_error([&] { water.point<2>("Velocity"); });
  expect_user_error([&] { water.function<3>("Force", 2); });
  expect_user_error([&] { water.function<2>("Force", 3); });
}

// A file may set again what the file it includes has set.
void
test_include()
{
  std::ofstream("base.prm") << "set Dimension = 3\nset End time = 2\n";
  std::ofstream("variant.prm") << "include base.prm\nset End time = 3\n";
  std::ofstream("circle.prm") << "include circle.prm\n";
  std::ofstream("wrong.prm") << "set Dimension = 3\n\ninclude wrong_part.prm\n";
  std::ofstream("wrong_part.prm") << "\nset Dimension = 7\n";
  Declaration root;
  declare(root);
  ParameterFile file(root);
  file.read("variant.prm");
  deallog << "Dimension " << file.parameters().integer("Dimension") << ", End time "
          << file.parameters().quantity("End time") << std::endl;
  for (const std::string name : {"circle.prm", "wrong.prm", "absent.prm", "."})
    expect_user_error([&] {
      file.read(name);
      file.parameters();
    });
}

int
main()
{
  initlog();
  test_refused();
  test_accepted();
  test_include();
}

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include "tests.h"

/// What VTK's readers see in a folder, as text into deallog. Call on one rank.
inline void
log_what_vtk_reads(const std::string &folder)
{
  const std::string command =
    std::string("/usr/bin/python3 " SOURCE_DIR "/read_with_vtk.py ") + folder + " > vtk.log 2>&1";
  const int     status = std::system(command.c_str());
  std::ifstream log("vtk.log");
  for (std::string line; std::getline(log, line);)
    deallog << line << std::endl;
  deallog << "read without complaint: " << (status == 0) << std::endl;
}

# Configure-time checks: what is missing, and which Debian package brings it.

# Stop with one message: what is missing, and how to get it.
function(coracle_missing what package)
  message(FATAL_ERROR
    "\n${what}\n"
    "On Debian or Ubuntu:  sudo apt-get install --no-install-recommends ${package}\n"
    "(contrib/quickstart installs everything that is needed.)\n")
endfunction()

macro(coracle_find_deal_ii)
  find_package(deal.II 9.4 QUIET HINTS ${DEAL_II_DIR} $ENV{DEAL_II_DIR})
  if(NOT deal.II_FOUND)
    coracle_missing(
      "deal.II 9.4 or later was not found. If you have built it yourself, configure with -DDEAL_II_DIR=<its folder>."
      libdeal.ii-dev)
  endif()
endmacro()

# After project(): the parts of deal.II, and the other libraries.
function(coracle_check_features)
  message(STATUS "deal.II ${DEAL_II_PACKAGE_VERSION} in ${DEAL_II_PATH}")
  foreach(feature MPI P4EST TRILINOS HDF5 CGAL)
    if(NOT DEAL_II_WITH_${feature})
      coracle_missing(
        "This deal.II (${DEAL_II_DIR}) was built without ${feature}, which Coracle needs. Debian's has it: configure with -DDEAL_II_DIR=/usr/share/cmake/deal.II once it is installed."
        libdeal.ii-dev)
    endif()
  endforeach()

  find_path(CORACLE_CLI11_INCLUDE CLI/App.hpp)
  if(NOT CORACLE_CLI11_INCLUDE)
    coracle_missing("CLI11, which reads the command line, was not found." libcli11-dev)
  endif()

  find_path(CORACLE_JSON_INCLUDE nlohmann/json.hpp)
  if(NOT CORACLE_JSON_INCLUDE)
    coracle_missing("nlohmann-json, which reads and writes manifests, was not found." nlohmann-json3-dev)
  endif()

  if(CORACLE_TESTS)
    find_program(NUMDIFF_EXECUTABLE numdiff HINTS ${NUMDIFF_DIR} PATH_SUFFIXES bin)
    if(NOT NUMDIFF_EXECUTABLE)
      coracle_missing(
        "numdiff, which compares the results of tests, was not found; -DCORACLE_TESTS=OFF builds without tests."
        numdiff)
    endif()
  endif()
  if(CORACLE_BENCHMARKS)
    find_package(benchmark QUIET)
    if(NOT benchmark_FOUND)
      coracle_missing(
        "Google Benchmark was not found; -DCORACLE_BENCHMARKS=OFF builds without benchmarks."
        libbenchmark-dev)
    endif()
  endif()
endfunction()

# Configure-time checks: which part of deal.II is missing, and which Debian package brings it.
foreach(feature MPI P4EST TRILINOS HDF5 CGAL)
  if(NOT DEAL_II_WITH_${feature})
    message(FATAL_ERROR
      "\nThis deal.II (${DEAL_II_DIR}) was built without ${feature}, which Coracle needs.\n"
      "On Debian or Ubuntu install the package libdeal.ii-dev, which has it, and configure with\n"
      "  cmake -DDEAL_II_DIR=/usr/share/cmake/deal.II ...\n")
  endif()
endforeach()

# One precompiled header a build, shared by all rooms and tests: deal.II's heavy headers and the
# standard library's. Sources include what they need as if it were not there
# (-DCORACLE_PRECOMPILED_HEADERS=OFF builds without it).
option(CORACLE_PRECOMPILED_HEADERS "Precompile deal.II's headers" ON)

# ccache when present. It must be told that precompiled headers are all right, and the compiler to
# leave a mark of them in what it preprocesses; otherwise nothing would be found in the cache.
find_program(CORACLE_CCACHE ccache)
if(CORACLE_CCACHE AND (NOT CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$"))
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    ${CORACLE_CCACHE})
endif()
if(CORACLE_PRECOMPILED_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(coracle_options INTERFACE -fpch-preprocess)
endif()

if(CORACLE_PRECOMPILED_HEADERS)
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cc.new "// Compiled only for its precompiled header.\n")
  configure_file(${CMAKE_BINARY_DIR}/precompiled.cc.new ${CMAKE_BINARY_DIR}/precompiled.cc COPYONLY)
  add_library(coracle_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cc)
  target_link_libraries(coracle_precompiled coracle_options)
  deal_ii_setup_target(coracle_precompiled)
  target_precompile_headers(coracle_precompiled PRIVATE
    <algorithm> <array> <cmath> <functional> <map> <memory> <sstream> <string> <vector>
    <deal.II/base/function.h>
    <deal.II/base/mpi.h>
    <deal.II/base/point.h>
    <deal.II/base/tensor.h>
    <deal.II/base/utilities.h>
    <deal.II/distributed/tria.h>
    <deal.II/dofs/dof_handler.h>
    <deal.II/dofs/dof_tools.h>
    <deal.II/fe/fe_q.h>
    <deal.II/fe/fe_values.h>
    <deal.II/grid/grid_generator.h>
    <deal.II/grid/tria.h>
    <deal.II/lac/la_parallel_vector.h>)
endif()

# coracle_use_precompiled(<target>): let the target share the precompiled header.
function(coracle_use_precompiled target)
  if(CORACLE_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM coracle_precompiled)
  endif()
endfunction()

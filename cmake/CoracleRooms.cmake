# The rooms of the code, and which rooms each may use (its own headers aside). The one table:
# unit tests link exactly these rooms, and contrib/check_rooms reads it to check the #include lines.
set(CORACLE_ROOMS base material mesh structure particles grid contact meshless coupling io)

set(CORACLE_base_USES)
set(CORACLE_material_USES   base)
set(CORACLE_mesh_USES       base)
set(CORACLE_structure_USES  base material mesh)
set(CORACLE_particles_USES  base material)
set(CORACLE_grid_USES       base particles)
set(CORACLE_contact_USES    base)
set(CORACLE_meshless_USES   base mesh contact)
set(CORACLE_coupling_USES   base material mesh structure particles grid contact meshless)
set(CORACLE_io_USES         base material mesh structure particles grid contact meshless coupling)

# coracle_rooms_of(<result> <room>): the existing object libraries that code of this room may call.
function(coracle_rooms_of result room)
  set(libraries)
  foreach(used ${room} ${CORACLE_${room}_USES})
    if(TARGET coracle_${used})
      list(APPEND libraries coracle_${used})
    endif()
  endforeach()
  set(${result} ${libraries} PARENT_SCOPE)
endfunction()

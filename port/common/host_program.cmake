# The program that makes tables runs on the machine that builds: a cross build of crankloop itself builds it along, as a
# build of its own in CRANKLOOP_HOST_TOOLS, and renews it whenever its sources have changed. Not needed where
# CRANKLOOP_PROGRAM names one.
set(CRANKLOOP_HOST_TOOLS "${PROJECT_BINARY_DIR}/host-tools" CACHE PATH "Where the program of the building machine is built")
cmake_host_system_information(RESULT crankloop_host_jobs QUERY NUMBER_OF_LOGICAL_CORES)
if(crankloop_host_jobs LESS 1)  # where there is no /proc to read it from
  set(crankloop_host_jobs 1)
endif()

add_custom_target(crankloop_host_program
  COMMAND ${CMAKE_COMMAND} -E env --unset=CXX --unset=CXXFLAGS --unset=LDFLAGS --unset=CMAKE_TOOLCHAIN_FILE
    ${CMAKE_COMMAND} -S "${PROJECT_SOURCE_DIR}" -B "${CRANKLOOP_HOST_TOOLS}" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1
  COMMAND ${CMAKE_COMMAND} --build "${CRANKLOOP_HOST_TOOLS}" --target crankloop_table_maker --parallel ${crankloop_host_jobs}
  BYPRODUCTS "${CRANKLOOP_HOST_TOOLS}/bin/crankloop_table_maker"
  COMMENT "The program that makes the tables, for the building machine"
  USES_TERMINAL
  VERBATIM)
set_target_properties(crankloop_host_program PROPERTIES CRANKLOOP_PROGRAM "${CRANKLOOP_HOST_TOOLS}/bin/crankloop_table_maker")

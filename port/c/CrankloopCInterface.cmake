# The C interface of engines: crankloop_add_scene(... WITH_C), and the library's own ready-made ones.

# NAME.h of the scene NAME, whose other headers are in DIR, and its functions, in the scene's library.
function(crankloop_scene_in_c name dir scene real tick_us)
  crankloop_c_interface(${name} ${name} SCENE "${scene}" REAL ${real} TICK ", ${tick_us} us per step"
    FORM "crankloop::c::CompiledIn<${name}::Real, ${name}::Engine>" FORM_HEADER "${name}.hpp" INCLUDES "${dir}"
    HEADER_DIR "${dir}" HEADER "${name}.h" SOURCE "${dir}/${name}_c.cpp")
  target_sources(${name} PRIVATE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/engine_c_words.cpp")
endfunction()

# The C interface of an engine: HEADER and SOURCE, which target TARGET compiles. FORM is where it has its tables from, a
# C++ type of FORM_HEADER (crankloop/c/engine.hpp). Only the compiler knows what a scene has and how large its engine is:
# it says so in an object file that is read, not run, so that cross-compiling is no different.
function(crankloop_c_interface target name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "SCENE;REAL;TICK;FORM;FORM_HEADER;HEADER_DIR;HEADER;SOURCE" "INCLUDES")
  set(templates "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  set(NAME "${name}")
  set(FORM "${arg_FORM}")
  set(FORM_HEADER "${arg_FORM_HEADER}")
  set(out "${arg_HEADER_DIR}/${arg_HEADER}")
  configure_file("${templates}/engine_c_facts.cpp.in" "${CMAKE_CURRENT_BINARY_DIR}/crankloop_c/${name}_facts.cpp" @ONLY)
  add_library(${name}_facts OBJECT "${CMAKE_CURRENT_BINARY_DIR}/crankloop_c/${name}_facts.cpp")
  target_include_directories(${name}_facts PRIVATE ${arg_INCLUDES})
  target_link_libraries(${name}_facts PRIVATE crankloop::headers)
  crankloop_house_flags(${name}_facts)
  add_custom_command(
    OUTPUT "${out}" "${arg_SOURCE}"
    COMMAND "${CMAKE_COMMAND}" -D "FACTS=$<TARGET_OBJECTS:${name}_facts>" -D "NAME=${name}" -D "SCENE=${arg_SCENE}"
      -D "REAL=${arg_REAL}" -D "TICK=${arg_TICK}" -D "FORM=${arg_FORM}" -D "FORM_HEADER=${arg_FORM_HEADER}"
      -D "HEADER=${arg_HEADER}" -D "OUT=${out}" -D "SOURCE=${arg_SOURCE}" -P "${templates}/engine_c.cmake"
    DEPENDS ${name}_facts "$<TARGET_OBJECTS:${name}_facts>" "${templates}/engine_c.cmake" "${templates}/engine_c.h.in"
      "${templates}/engine_c.cpp.in"
    COMMENT "C interface of ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE "${arg_SOURCE}" "${out}")
  add_custom_target(${name}_c DEPENDS "${out}" "${arg_SOURCE}")  # made once, also where two targets compile them
  add_dependencies(${target} ${name}_c)
endfunction()

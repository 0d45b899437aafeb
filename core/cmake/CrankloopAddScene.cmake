# crankloop_add_scene(NAME SCENE_HEADER ENGINE_FILE [TICK_US 100] [REAL float|double] [SCENE Type]
#                     [INTEGRATOR rk4|exponential] [ACCURACY_UM 0.1] [WITH_C])
#
# Makes the static library NAME: one engine for real time, its tables as constant data and its tick compiled with the house flags.
# A program links NAME and includes "NAME.hpp", where namespace NAME has Engine, Input, Output, State.
#
#   SCENE_HEADER  a header with the scene, a struct derived from crankloop::Scene
#   ENGINE_FILE   the engine, as the command-line program reads it
#   TICK_US       microseconds from one step to the next; default 100
#   REAL          the arithmetic of the tick; default float
#   SCENE         the scene's type; default the header's name in CamelCase: my_scene.hpp has MyScene
#   INTEGRATOR    of elastic valves: Runge-Kutta of fourth order, or the exact exponential of each contact regime; default rk4
#   ACCURACY_UM   class of the valves' lift error in micrometres, 0.01 to 10: it sets the fine steps near contact changes; default 0.1
#   WITH_C        also "NAME.h" for C99: NAME_engine, NAME_init(), NAME_step(), NAME_get_...() for what the scene has
#
# The tables are made by the command-line program, on the machine that builds. Where that program cannot be built along (when
# cross-compiling), set CRANKLOOP_PROGRAM to one that was installed, of this version, or have it on the PATH.

include("${CMAKE_CURRENT_LIST_DIR}/CrankloopHouseFlags.cmake")

function(crankloop_add_scene name scene_header engine_file)
  cmake_parse_arguments(PARSE_ARGV 3 arg "WITH_C" "TICK_US;REAL;SCENE;INTEGRATOR;ACCURACY_UM" "")
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "crankloop_add_scene(${name}): not understood: ${arg_UNPARSED_ARGUMENTS} ${arg_KEYWORDS_MISSING_VALUES}")
  endif()
  if(NOT name MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
    message(FATAL_ERROR "crankloop_add_scene(${name}): the name becomes a C++ namespace, so it must be an identifier")
  endif()
  if(NOT DEFINED arg_TICK_US)
    set(arg_TICK_US 100)
  endif()
  if(NOT DEFINED arg_REAL)
    set(arg_REAL float)
  elseif(NOT arg_REAL MATCHES "^(float|double)$")
    message(FATAL_ERROR "crankloop_add_scene(${name}): REAL is float or double, not '${arg_REAL}'")
  endif()
  if(NOT DEFINED arg_INTEGRATOR)
    set(arg_INTEGRATOR rk4)
  elseif(NOT arg_INTEGRATOR MATCHES "^(rk4|exponential)$")
    message(FATAL_ERROR "crankloop_add_scene(${name}): INTEGRATOR is rk4 or exponential, not '${arg_INTEGRATOR}'")
  endif()
  if(NOT DEFINED arg_ACCURACY_UM)
    set(arg_ACCURACY_UM 0.1)
  endif()
  if(NOT DEFINED arg_SCENE)
    crankloop_camel_case(arg_SCENE "${scene_header}")
  endif()
  cmake_path(ABSOLUTE_PATH scene_header NORMALIZE)
  cmake_path(ABSOLUTE_PATH engine_file NORMALIZE)
  foreach(file IN ITEMS "${scene_header}" "${engine_file}")
    if(NOT EXISTS "${file}")
      message(FATAL_ERROR "crankloop_add_scene(${name}): there is no ${file}")
    endif()
  endforeach()

  set(dir "${CMAKE_CURRENT_BINARY_DIR}/crankloop_scenes/${name}")
  set(tables "${dir}/${name}_tables.hpp")
  crankloop_program(program)
  crankloop_tables_of_engine_file(pressure_tables "${engine_file}")
  # A program that is newer makes the tables again; only where they differ is what they are compiled into compiled again.
  add_custom_command(
    OUTPUT "${tables}.made"
    BYPRODUCTS "${tables}"
    COMMAND "${program}" tables "${engine_file}" --tick-us "${arg_TICK_US}" --real "${arg_REAL}"
      --integrator "${arg_INTEGRATOR}" --accuracy-um "${arg_ACCURACY_UM}" --output "${tables}.made"
    COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${tables}.made" "${tables}"
    DEPENDS "${program}" "${engine_file}" ${pressure_tables}
    COMMENT "Tables of ${name}"
    VERBATIM)

  set(SCENE_NAME "${name}")
  set(SCENE_HEADER "${scene_header}")
  set(SCENE_TYPE "${arg_SCENE}")
  set(SCENE_REAL "${arg_REAL}")
  set(SCENE_TICK_US "${arg_TICK_US}")
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene.hpp.in" "${dir}/${name}.hpp" @ONLY)
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene.cpp.in" "${dir}/${name}.cpp" @ONLY)
  add_library(${name} STATIC "${dir}/${name}.cpp" "${dir}/${name}.hpp" "${tables}.made")
  target_include_directories(${name} PUBLIC "${dir}")
  target_link_libraries(${name} PUBLIC crankloop::crankloop)
  if(TARGET crankloop_host_program)  # a cross build of crankloop itself: port/common/host_program.cmake
    add_dependencies(${name} crankloop_host_program)
  endif()
  crankloop_house_flags(${name})
  if(arg_WITH_C)
    crankloop_add_c_glue("${name}" "${dir}")
  endif()
endfunction()

# NAME.h and NAME_c.cpp. Only the compiler knows what a scene has and how large its engine is: it says so in an object file that is read, not
# run, so that cross-compiling is no different.
function(crankloop_add_c_glue name dir)
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene_facts.cpp.in" "${dir}/${name}_facts.cpp" @ONLY)
  add_library(${name}_facts OBJECT "${dir}/${name}_facts.cpp")
  target_include_directories(${name}_facts PRIVATE "${dir}")
  target_link_libraries(${name}_facts PRIVATE crankloop::crankloop)
  crankloop_house_flags(${name}_facts)
  set(templates "")
  foreach(file IN ITEMS scene_c.cmake scene_c.h.in scene_c.cpp.in)
    list(APPEND templates "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${file}")
  endforeach()
  add_custom_command(
    OUTPUT "${dir}/${name}.h" "${dir}/${name}_c.cpp"
    COMMAND "${CMAKE_COMMAND}" -D "FACTS=$<TARGET_OBJECTS:${name}_facts>" -D "NAME=${name}" -D "SCENE_TYPE=${SCENE_TYPE}"
      -D "REAL=${SCENE_REAL}" -D "TICK_US=${SCENE_TICK_US}" -D "DIR=${dir}" -P "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene_c.cmake"
    DEPENDS ${name}_facts "$<TARGET_OBJECTS:${name}_facts>" ${templates}
    COMMENT "C interface of ${name}"
    VERBATIM)
  target_sources(${name} PRIVATE "${dir}/${name}_c.cpp" "${dir}/${name}.h")
endfunction()

# path/to/my_scene.hpp -> MyScene
function(crankloop_camel_case result header)
  cmake_path(GET header STEM LAST_ONLY stem)
  string(REGEX MATCHALL "[A-Za-z0-9]+" words "${stem}")
  set(type "")
  foreach(word IN LISTS words)
    string(SUBSTRING "${word}" 0 1 first)
    string(SUBSTRING "${word}" 1 -1 rest)
    string(TOUPPER "${first}" first)
    string(APPEND type "${first}${rest}")
  endforeach()
  set(${result} "${type}" PARENT_SCOPE)
endfunction()

# The program that makes the tables: named by the user, built along or installed with the library, or found on the PATH.
function(crankloop_program result)
  if(NOT CRANKLOOP_PROGRAM AND NOT CMAKE_CROSSCOMPILING)
    foreach(program IN ITEMS crankloop_table_maker crankloop::program)
      if(TARGET ${program})
        set(${result} "$<TARGET_FILE:${program}>" PARENT_SCOPE)
        return()
      endif()
    endforeach()
  endif()
  find_program(CRANKLOOP_PROGRAM crankloop DOC "The crankloop program of the machine that builds, of the library's version")
  if(NOT CRANKLOOP_PROGRAM)
    message(FATAL_ERROR "crankloop_add_scene: no program to make the tables with; set CRANKLOOP_PROGRAM to an installed crankloop")
  endif()
  set(${result} "${CRANKLOOP_PROGRAM}" PARENT_SCOPE)
endfunction()

# The files that an engine file names by "file = ...": the tables depend on them too. Read anew whenever the engine file changes.
function(crankloop_tables_of_engine_file result engine_file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${engine_file}")
  file(STRINGS "${engine_file}" lines REGEX "^[ \t]*file[ \t]*=")
  cmake_path(GET engine_file PARENT_PATH dir)
  set(files "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[^=]*=[ \t]*([^#]*)(#.*)?$" "\\1" file "${line}")
    string(STRIP "${file}" file)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${dir}" NORMALIZE)
    if(EXISTS "${file}")  # the program says best what is wrong with a missing one
      list(APPEND files "${file}")
    endif()
  endforeach()
  set(${result} "${files}" PARENT_SCOPE)
endfunction()

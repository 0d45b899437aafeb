# crankloop_add_scene(NAME SCENE_HEADER ENGINE_FILE [TICK_US 100] [REAL float|double] [SCENE Type]
#                     [INTEGRATOR rk4|exponential] [ACCURACY_UM 0.1] [EVENT_BUDGET 6] [MAX_RPM 9000]
#                     [OPTIMIZATION -O3] [WITH_C] [WITH_FMU])
#
# Makes the static library NAME: one engine for real time, its tables as constant data and its tick compiled with the
# house flags. A program links NAME and includes "NAME.hpp", where namespace NAME has Engine, Input, Output, State.
#
#   SCENE_HEADER  a header with the scene, a struct derived from crankloop::Scene
#   ENGINE_FILE   the engine, as the command-line program reads it
#   TICK_US       microseconds from one step to the next; default 100
#   REAL          the arithmetic of the tick; default float
#   SCENE         the scene's type; default the header's name in CamelCase: my_scene.hpp has MyScene
#   INTEGRATOR    of elastic valves: Runge-Kutta of fourth order, or the exact exponential of each contact regime; default rk4
#   ACCURACY_UM   class of the valves' lift error in micrometres, 0.01 to 10: it sets the fine steps near contact changes; default 0.1
#   EVENT_BUDGET  units of work for valve events in a tick, which bound its time: a fine step takes 1, an event 2 or 3; default: enough for every valve at once
#   MAX_RPM       the highest speed the engine can have: a step refuses a faster one; default max_rpm of the engine file,
#                 and without it one revolution per tick or 100 000 rpm
#   OPTIMIZATION  -O0 to -O3, -Os, -Og or -Oz for the scene's library, whatever the project's build type; "project": as the
#                 project compiles its own code; default the variable CRANKLOOP_SCENE_OPTIMIZATION, or -O3 without it
#   WITH_C        also "NAME.h" for C99: NAME_create(), NAME_step(), NAME_read(), with structs of what the scene has
#   WITH_FMU      also NAME_fmi2.fmu and NAME_fmi3.fmu, for any simulator that imports FMI 2.0 or 3.0: docs/fmi.md
#
# The tables are made by the command-line program, on the machine that builds: built along (by add_subdirectory, also
# when cross-compiling), installed with the library, CRANKLOOP_PROGRAM, or found on the PATH; it must be of this version.

function(crankloop_add_scene name scene_header engine_file)
  cmake_parse_arguments(PARSE_ARGV 3 arg "WITH_C;WITH_FMU" "TICK_US;REAL;SCENE;INTEGRATOR;ACCURACY_UM;EVENT_BUDGET;MAX_RPM;OPTIMIZATION" "")
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "crankloop_add_scene(${name}): not understood: ${arg_UNPARSED_ARGUMENTS} ${arg_KEYWORDS_MISSING_VALUES}")
  endif()
  crankloop_require_name("${name}")
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
  if(NOT DEFINED arg_OPTIMIZATION)
    set(arg_OPTIMIZATION -O3)
    if(DEFINED CRANKLOOP_SCENE_OPTIMIZATION)
      set(arg_OPTIMIZATION "${CRANKLOOP_SCENE_OPTIMIZATION}")
    endif()
  endif()
  if(NOT arg_OPTIMIZATION MATCHES "^(-O[0123sgz]|project)$")
    message(FATAL_ERROR "crankloop_add_scene(${name}): OPTIMIZATION is -O0 to -O3, -Os, -Og, -Oz or project, not '${arg_OPTIMIZATION}'")
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

  set(limits "")
  if(DEFINED arg_EVENT_BUDGET)
    list(APPEND limits --event-budget "${arg_EVENT_BUDGET}")
  endif()
  if(DEFINED arg_MAX_RPM)
    list(APPEND limits --max-rpm "${arg_MAX_RPM}")
  endif()

  set(dir "${CMAKE_CURRENT_BINARY_DIR}/crankloop_scenes/${name}")
  set(tables "${dir}/${name}_tables.hpp")
  crankloop_program(program)
  crankloop_tables_of_engine_file(pressure_tables "${engine_file}")
  # A program that is newer makes the tables again; only where they differ is what they are compiled into compiled
  # again.
  add_custom_command(
    OUTPUT "${tables}.made"
    BYPRODUCTS "${tables}"
    COMMAND "${program}" tables "${engine_file}" --tick-us "${arg_TICK_US}" --real "${arg_REAL}"
      --integrator "${arg_INTEGRATOR}" --accuracy-um "${arg_ACCURACY_UM}" ${limits} --output "${tables}.made"
    COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${tables}.made" "${tables}"
    DEPENDS "${program}" "${engine_file}" ${pressure_tables}
    COMMENT "Tables of ${name}"
    VERBATIM)

  set(SCENE_NAME "${name}")
  set(SCENE_HEADER "${scene_header}")
  set(SCENE_TYPE "${arg_SCENE}")
  set(SCENE_REAL "${arg_REAL}")
  set(SCENE_TICK_US "${arg_TICK_US}")
  crankloop_write_scene_header("${dir}/${name}.hpp")
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene.cpp.in" "${dir}/${name}.cpp" @ONLY)
  add_library(${name} STATIC "${dir}/${name}.cpp" "${dir}/${name}.hpp" "${tables}.made")
  target_include_directories(${name} PUBLIC "${dir}")
  target_link_libraries(${name} PUBLIC crankloop::headers)
  if(TARGET crankloop_host_program)  # a cross build of crankloop itself: port/common/host_program.cmake
    add_dependencies(${name} crankloop_host_program)
  endif()
  crankloop_house_flags(${name})
  crankloop_optimization(${name} ${arg_OPTIMIZATION})
  if(arg_WITH_C)
    crankloop_scene_in_c(${name} "${dir}" "${arg_SCENE}" ${arg_REAL} "${arg_TICK_US}")
  endif()
  if(arg_WITH_FMU)
    crankloop_add_fmu("${name}" "${dir}" "${program}" ${arg_OPTIMIZATION})
  endif()
endfunction()

# The header of the scene that SCENE_NAME and the like describe.
function(crankloop_write_scene_header file)
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scene.hpp.in" "${file}" @ONLY)
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

# The program that makes the tables: named by the user, built along, installed with the library, or found on the PATH.
function(crankloop_program result)
  if(NOT CRANKLOOP_PROGRAM)
    if(TARGET crankloop_host_program)  # a cross build of crankloop: port/common/host_program.cmake
      get_target_property(program crankloop_host_program CRANKLOOP_PROGRAM)
      set(${result} "${program}" PARENT_SCOPE)
      return()
    endif()
    if(TARGET crankloop_table_maker AND NOT CMAKE_CROSSCOMPILING)
      set(${result} "$<TARGET_FILE:crankloop_table_maker>" PARENT_SCOPE)
      return()
    endif()
    get_property(installed GLOBAL PROPERTY CRANKLOOP_INSTALLED_PROGRAM)
    crankloop_why_no_table_maker(why "${installed}")
    if(NOT why)
      set(${result} "${installed}" PARENT_SCOPE)
      return()
    endif()
  endif()
  find_program(CRANKLOOP_PROGRAM crankloop DOC "The crankloop program of the machine that builds, of the library's version")
  if(NOT CRANKLOOP_PROGRAM)
    message(FATAL_ERROR "crankloop_add_scene: no program to make the tables with; set CRANKLOOP_PROGRAM to an installed crankloop")
  endif()
  crankloop_why_no_table_maker(why "${CRANKLOOP_PROGRAM}")
  if(why)
    message(FATAL_ERROR "crankloop_add_scene: CRANKLOOP_PROGRAM = ${CRANKLOOP_PROGRAM} ${why}")
  endif()
  set(${result} "${CRANKLOOP_PROGRAM}" PARENT_SCOPE)
endfunction()

# Empty for a program of this machine and of the library's version.
function(crankloop_why_no_table_maker result program)
  get_property(version GLOBAL PROPERTY CRANKLOOP_VERSION)
  set(said "")
  set(status "it does not exist")
  if(EXISTS "${program}")
    execute_process(COMMAND "${program}" --version OUTPUT_VARIABLE said ERROR_QUIET RESULT_VARIABLE status
      OUTPUT_STRIP_TRAILING_WHITESPACE)
  endif()
  string(REGEX REPLACE "\n.*" "" said "${said}")
  set(why "")
  if(NOT status STREQUAL 0)
    set(why "does not run here (${status}); crankloop ${version} is needed")
  elseif(NOT said STREQUAL "crankloop ${version}")
    set(why "is '${said}'; crankloop ${version} is needed")
  endif()
  set(${result} "${why}" PARENT_SCOPE)
endfunction()

# Names become C++ namespaces, and prefixes in C.
function(crankloop_require_name name)
  if(NOT name MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
    message(FATAL_ERROR "crankloop_add_scene(${name}): the name becomes a C++ namespace, so it must be an identifier")
  endif()
  set(words
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class co_await
    co_return co_yield compl concept const const_cast consteval constexpr constinit continue crankloop crankloop_tables
    decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if
    inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public
    register reinterpret_cast requires restrict return short signed sizeof static static_assert static_cast std struct
    switch template this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile
    wchar_t while xor xor_eq)
  if(name IN_LIST words)
    message(FATAL_ERROR "crankloop_add_scene(${name}): the name becomes a C++ namespace, and C++ uses '${name}' itself")
  endif()
endfunction()

# The files that an engine file names by "file = ...": the tables depend on them too. Read anew whenever the engine file
# changes.
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

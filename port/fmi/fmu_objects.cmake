# FMUs of an engine file: what `crankloop fmu` packs, ../lib/crankloop from the program.
#
#   fmu_SCENE_REAL.so, .dll   the binaries; they bring along what reads and tabulates the file, compiled anew for a
#                             shared object
#   fmu_sources/              what they are compiled from: the FMU's sources/
#
# crankloop_fmu_objects(PLATFORM FLAGS BASE folder EXPORTS file READER file... HEADERS file...)
#
# PLATFORM and FLAGS become FMI 3's name of this platform and the flags that the sources ask for. Of the reader of engine
# files, below BASE in the current source folder: EXPORTS is the source with FMI's functions, READER its other sources,
# HEADERS what they include.
function(crankloop_fmu_objects platform_result flags_result)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "BASE;EXPORTS" "READER;HEADERS")
  set(fmu_dir ${crankloop_BINARY_DIR}/lib/crankloop)
  set(include_dirs ${crankloop_SOURCE_DIR}/core/include ${crankloop_SOURCE_DIR}/port/fmi/include)
  string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}-${CMAKE_SYSTEM_NAME}" platform)
  set(${platform_result} "${platform}" PARENT_SCOPE)

  get_target_property(core_sources crankloop SOURCES)
  list(FILTER core_sources INCLUDE REGEX "^src/")  # not what a port adds
  list(FILTER core_sources EXCLUDE REGEX "^src/tick/(measured_motion|torque_by_pressure|torque_by_table)")
  list(TRANSFORM core_sources PREPEND ${crankloop_SOURCE_DIR}/core/)
  add_library(crankloop_fmu_core OBJECT ${core_sources})
  target_include_directories(crankloop_fmu_core PRIVATE ${crankloop_SOURCE_DIR}/core/src)
  crankloop_house_flags(crankloop_fmu_core)

  add_library(crankloop_fmu_reader OBJECT ${arg_READER})
  crankloop_numerics(crankloop_fmu_reader)
  set_target_properties(crankloop_fmu_reader PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)  # as the program's
  foreach(target IN ITEMS crankloop_fmu_core crankloop_fmu_reader)
    target_include_directories(${target} PRIVATE ${include_dirs})
    crankloop_warnings(${target})
    set_target_properties(${target} PROPERTIES
      POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endforeach()

  add_custom_target(crankloop_fmus ALL)
  foreach(crank IN ITEMS speed torque gas_speed gas_torque)
    set(scene_of_speed Whole)
    set(scene_of_torque FreeRunning)
    set(scene_of_gas_speed Breathing)
    set(scene_of_gas_torque BreathingFree)
    foreach(real IN ITEMS float double)
      set(object crankloop_fmu_${crank}_${real})
      add_library(${object} MODULE ${arg_EXPORTS}
        $<TARGET_OBJECTS:crankloop_fmu_core> $<TARGET_OBJECTS:crankloop_fmu_reader>)
      target_include_directories(${object} PRIVATE ${include_dirs})
      target_compile_definitions(${object} PRIVATE
        CRANKLOOP_FMU_SCENE=${scene_of_${crank}} CRANKLOOP_FMU_REAL=${real})
      crankloop_fmu_link(${object} fmu_${crank}_${real})
      set_target_properties(${object} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${fmu_dir})
      crankloop_numerics(${object})
      crankloop_warnings(${object})
      add_dependencies(crankloop_fmus ${object})
    endforeach()
  endforeach()
  if(WIN32)
    return()  # what follows is the packing program's, which is not built here
  endif()

  # Their sources, as they lie in the FMU: include/ and core/ of the library's, program/ of the reader's.
  set(fmu_sources ${fmu_dir}/fmu_sources)
  file(GLOB_RECURSE core_headers RELATIVE ${crankloop_SOURCE_DIR}/core/src CONFIGURE_DEPENDS ${crankloop_SOURCE_DIR}/core/src/*.hpp)
  set(packed_core ${core_sources} ${core_headers})
  list(TRANSFORM packed_core REPLACE "^${crankloop_SOURCE_DIR}/core/src/" "")
  set(packed_reader ${arg_READER} ${arg_EXPORTS} ${arg_HEADERS})
  list(TRANSFORM packed_reader REPLACE "^${arg_BASE}/" "")
  set(packed "")
  set(copies "")
  foreach(include_dir IN LISTS include_dirs)
    file(GLOB_RECURSE headers RELATIVE ${include_dir} CONFIGURE_DEPENDS ${include_dir}/crankloop/*)
    crankloop_pack_sources(${include_dir} ${fmu_sources}/include ${headers})
  endforeach()
  crankloop_pack_sources(${crankloop_SOURCE_DIR}/core/src ${fmu_sources}/core ${packed_core})
  crankloop_pack_sources(${CMAKE_CURRENT_SOURCE_DIR}/${arg_BASE} ${fmu_sources}/program ${packed_reader})
  add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/fmu_sources.made
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${fmu_sources}
    ${copies}
    COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_CURRENT_BINARY_DIR}/fmu_sources.made
    DEPENDS ${packed}
    COMMENT "Sources of the engine files' FMUs"
    VERBATIM)
  add_custom_target(crankloop_fmu_sources ALL DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/fmu_sources.made)
  add_dependencies(crankloop_fmus crankloop_fmu_sources)
  crankloop_gcc_flags(flags crankloop_fmu_reader)
  set(${flags_result} "${flags}" PARENT_SCOPE)

  # Those for Windows: a build of their own, which MinGW-w64 does.
  crankloop_windows_compiler(windows_compiler)
  if(windows_compiler)
    set(windows_build ${crankloop_BINARY_DIR}/windows-fmus)
    add_custom_target(crankloop_windows_fmus ALL
      COMMAND ${CMAKE_COMMAND} -E env --unset=CXX --unset=CXXFLAGS --unset=LDFLAGS
        ${CMAKE_COMMAND} -S ${crankloop_SOURCE_DIR} -B ${windows_build} -G ${CMAKE_GENERATOR}
          -DCMAKE_TOOLCHAIN_FILE=${crankloop_SOURCE_DIR}/port/windows/toolchain.cmake -DCRANKLOOP_MINGW_CXX=${windows_compiler}
          -DCMAKE_BUILD_TYPE=Release -DCRANKLOOP_BUILD_PROGRAM=ON -DCRANKLOOP_INSTALL=OFF
          -DCRANKLOOP_DEVELOPER=${CRANKLOOP_DEVELOPER}
          -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
      COMMAND ${CMAKE_COMMAND} --build ${windows_build} --target crankloop_fmus
      COMMAND ${CMAKE_COMMAND} -E copy_directory ${windows_build}/lib/crankloop ${fmu_dir}
      COMMENT "FMUs' objects for Windows"
      USES_TERMINAL
      VERBATIM)
    add_dependencies(crankloop_fmus crankloop_windows_fmus)
  else()
    file(GLOB stale ${fmu_dir}/*.dll)
    if(stale)
      file(REMOVE ${stale})
    endif()
  endif()
endfunction()

# Adds copies of FILE..., below FROM, to the commands `copies`, and the files to the list `packed`.
function(crankloop_pack_sources from to)  # FILE...
  foreach(file IN LISTS ARGN)
    cmake_path(GET file PARENT_PATH folder)
    list(APPEND files_of_${folder} "${from}/${file}")
    list(APPEND folders "${folder}")
    list(APPEND packed "${from}/${file}")
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN LISTS folders)
    list(APPEND copies COMMAND ${CMAKE_COMMAND} -E make_directory ${to}/${folder}
      COMMAND ${CMAKE_COMMAND} -E copy ${files_of_${folder}} ${to}/${folder})
  endforeach()
  set(packed "${packed}" PARENT_SCOPE)
  set(copies "${copies}" PARENT_SCOPE)
endfunction()

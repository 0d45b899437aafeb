# FMUs of a scene: crankloop_add_scene(... WITH_FMU). One shared object for each platform has the functions of FMI 2.0 and
# 3.0; on Linux there is, beside the platform's own, one for 64-bit Windows where MinGW-w64 is at hand:
#
#   CRANKLOOP_FMU_WINDOWS  whether; on where the compiler is found, and then demanded
#   CRANKLOOP_MINGW_CXX    the compiler

# What a Windows object is linked with: nothing but the functions marked for it is seen from outside, nothing needed but
# the system's own libraries, and neither a time of day nor an address by its path written into it.
function(crankloop_windows_link_options result)
  set(${result} -static -Wl,--exclude-all-symbols -Wl,--gc-sections -Wl,--no-insert-timestamp -Wl,--disable-auto-image-base -s PARENT_SCOPE)
endfunction()

# The compiler of the Windows object beside this platform's; empty: there will be none.
function(crankloop_windows_compiler result)
  set(${result} "" PARENT_SCOPE)
  if(CMAKE_CROSSCOMPILING OR NOT CMAKE_SYSTEM_NAME STREQUAL Linux)
    return()
  endif()
  find_program(CRANKLOOP_MINGW_CXX DOC "MinGW-w64's g++ for 64-bit Windows"
    NAMES x86_64-w64-mingw32-g++-posix x86_64-w64-mingw32-g++ x86_64-w64-mingw32-g++-win32)
  mark_as_advanced(CRANKLOOP_MINGW_CXX)
  set(missing "there is no x86_64-w64-mingw32-g++ (Debian's g++-mingw-w64-x86-64-posix)")
  if(CRANKLOOP_MINGW_CXX)
    set(found ON)
  else()
    set(found OFF)
    if(NOT DEFINED CACHE{CRANKLOOP_FMU_WINDOWS})
      message(STATUS "crankloop: FMUs will have no binary for Windows: ${missing}")
    endif()
  endif()
  option(CRANKLOOP_FMU_WINDOWS "FMUs also have a binary for 64-bit Windows" ${found})
  if(NOT CRANKLOOP_FMU_WINDOWS)
    return()
  endif()
  if(NOT CRANKLOOP_MINGW_CXX)
    message(FATAL_ERROR "crankloop: CRANKLOOP_FMU_WINDOWS is on, but ${missing}")
  endif()
  set(${result} "${CRANKLOOP_MINGW_CXX}" PARENT_SCOPE)
endfunction()

# The flags of a target, in one text, as the sources in an FMU are to be compiled by GCC.
function(crankloop_gcc_flags result target)
  get_target_property(flags ${target} COMPILE_OPTIONS)
  list(FILTER flags EXCLUDE REGEX "^[$-]W|<NOT:")  # warnings, and what is another compiler's
  list(TRANSFORM flags REPLACE "^[$]<[$]<CXX_COMPILER_ID:GNU>:(.*)>$" "\\1")
  if(NOT flags MATCHES "(^|;)-O")
    list(PREPEND flags -O2)
  endif()
  list(PREPEND flags -std=c++17 -fvisibility=hidden)
  list(JOIN flags " " flags)
  set(${result} "${flags}" PARENT_SCOPE)
endfunction()

# Where the headers are that FMUs are made of: of core and of FMI in the source tree, one folder in an install.
function(crankloop_fmu_include_dirs result)
  get_property(include_dirs GLOBAL PROPERTY CRANKLOOP_FMU_INCLUDE_DIRS)
  set(${result} "${include_dirs}" PARENT_SCOPE)
endfunction()

# FMI's two names of the platform that is built for, and what its shared objects end in.
function(crankloop_fmu_platform folder_of_2 folder_of_3 suffix)
  set(platform "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}")
  set(${suffix} .so PARENT_SCOPE)
  if(platform MATCHES "^Linux-(x86_64|AMD64)$")
    set(${folder_of_2} linux64 PARENT_SCOPE)
    set(${folder_of_3} x86_64-linux PARENT_SCOPE)
  elseif(platform MATCHES "^Linux-aarch64$")
    set(${folder_of_2} aarch64-linux PARENT_SCOPE)  # FMI 2 has no name for it
    set(${folder_of_3} aarch64-linux PARENT_SCOPE)
  elseif(platform MATCHES "^Windows-(x86_64|AMD64)$")
    set(${folder_of_2} win64 PARENT_SCOPE)
    set(${folder_of_3} x86_64-windows PARENT_SCOPE)
    set(${suffix} .dll PARENT_SCOPE)
  else()
    message(FATAL_ERROR "crankloop: FMUs are made for Linux on x86_64 and aarch64 and for Windows on x86_64, not for ${platform}")
  endif()
endfunction()

# NAME_fmi2.fmu and NAME_fmi3.fmu in the current binary folder. The files beside the shared objects are written by a program
# that is compiled with the scene: when cross-compiling, it needs an emulator.
function(crankloop_add_fmu name dir program optimization)
  crankloop_fmu_platform(folder_of_2 folder_of_3 suffix)
  set(templates "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  crankloop_fmu_include_dirs(include_dirs)
  set(SCENE_TITLE "${SCENE_TYPE} of ${name}")
  crankloop_gcc_flags(SCENE_FLAGS ${name})
  separate_arguments(flags UNIX_COMMAND "${SCENE_FLAGS}")
  configure_file("${templates}/scene_fmu.hpp.in" "${dir}/${name}_fmu.hpp" @ONLY)
  configure_file("${templates}/scene_fmu.cpp.in" "${dir}/${name}_fmu.cpp" @ONLY)
  configure_file("${templates}/scene_fmu_files.cpp.in" "${dir}/${name}_fmu_files.cpp" @ONLY)
  set(all_headers "")
  set(headers "")
  set(folders "")
  foreach(include_dir IN LISTS include_dirs)
    file(GLOB_RECURSE found "${include_dir}/crankloop/*.hpp" "${include_dir}/crankloop/*.h" "${include_dir}/crankloop/*.inc")
    list(APPEND all_headers ${found})
    file(GLOB found "${include_dir}/crankloop/*.hpp" "${include_dir}/crankloop/version.h")
    list(APPEND headers ${found})
    file(GLOB found "${include_dir}/crankloop/fmi" "${include_dir}/crankloop/tables" "${include_dir}/crankloop/tick"
      "${include_dir}/crankloop/variables")
    list(APPEND folders ${found})
  endforeach()

  add_library(${name}_fmu MODULE "${dir}/${name}.cpp" "${dir}/${name}_fmu.cpp" "${dir}/${name}_tables.hpp.made")
  target_include_directories(${name}_fmu PRIVATE "${dir}" ${include_dirs})  # headers alone: nothing of the library
  crankloop_house_flags(${name}_fmu)
  crankloop_optimization(${name}_fmu ${optimization})
  crankloop_fmu_link(${name}_fmu ${name})
  add_dependencies(${name}_fmu ${name})  # its tables are made once

  set(windows_object "")
  crankloop_windows_compiler(windows_compiler)
  if(windows_compiler)
    set(windows_object "${dir}/${name}.dll")
    crankloop_windows_link_options(link_options)
    set(include_flags ${dir} ${include_dirs})
    list(TRANSFORM include_flags PREPEND -I)
    set(compile ${CMAKE_CXX_COMPILER_LAUNCHER} "${windows_compiler}" ${flags} ${include_flags})
    add_custom_command(OUTPUT "${windows_object}"
      COMMAND ${compile} -c "${dir}/${name}.cpp" -o "${dir}/${name}.obj"
      COMMAND ${compile} -c "${dir}/${name}_fmu.cpp" -o "${dir}/${name}_fmu.obj"
      COMMAND "${windows_compiler}" -shared ${link_options} "${dir}/${name}.obj" "${dir}/${name}_fmu.obj"
        -o "${windows_object}"
      DEPENDS "${dir}/${name}.cpp" "${dir}/${name}_fmu.cpp" "${dir}/${name}_fmu.hpp" "${dir}/${name}.hpp"
        "${dir}/${name}_tables.hpp.made" "${SCENE_HEADER}" ${all_headers}
      COMMENT "FMU's Windows object of ${name}"
      VERBATIM)
  endif()

  add_executable(${name}_fmu_files "${dir}/${name}_fmu_files.cpp")
  target_link_libraries(${name}_fmu_files PRIVATE ${name})
  crankloop_numerics(${name}_fmu_files)
  crankloop_optimization(${name}_fmu_files -O1)  # it runs once

  # Sources that compile where nothing of this machine is: the scene's header by its name alone.
  cmake_path(GET SCENE_HEADER FILENAME header_name)
  set(kept_header "${SCENE_HEADER}")
  set(SCENE_HEADER "${header_name}")
  crankloop_write_scene_header("${dir}/fmu_sources/${name}.hpp")
  foreach(FMI IN ITEMS 2 3)
    configure_file("${templates}/scene_fmu_source.cpp.in" "${dir}/fmu_sources/all_${FMI}.cpp" @ONLY)
  endforeach()

  set(license "${templates}/LICENSE")
  if(NOT EXISTS "${license}")
    set(license "${templates}/../../LICENSE")
  endif()
  set(stage "${dir}/fmu")
  set(commands COMMAND "${CMAKE_COMMAND}" -E rm -rf "${stage}"
               COMMAND ${name}_fmu_files "${stage}/2" "${stage}/3")
  set(windows_folder_of_2 win64)
  set(windows_folder_of_3 x86_64-windows)
  foreach(fmi IN ITEMS 2 3)
    set(root "${stage}/${fmi}")
    set(include "${root}/sources/include")
    set(binaries "${root}/binaries/${folder_of_${fmi}}")
    set(fmu "${CMAKE_CURRENT_BINARY_DIR}/${name}_fmi${fmi}.fmu")
    list(APPEND commands
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${binaries}" "${root}/documentation/licenses" "${include}/crankloop"
      COMMAND "${CMAKE_COMMAND}" -E copy "$<TARGET_FILE:${name}_fmu>" "${binaries}/${name}${suffix}"
      COMMAND "${CMAKE_COMMAND}" -E copy "${license}" "${root}/documentation/licenses/license.txt"
      COMMAND "${CMAKE_COMMAND}" -E copy "${dir}/fmu_sources/all_${fmi}.cpp" "${root}/sources/all.cpp"
      COMMAND "${CMAKE_COMMAND}" -E copy "${dir}/${name}.cpp" "${dir}/${name}_tables.hpp" "${dir}/${name}_fmu.hpp"
        "${dir}/fmu_sources/${name}.hpp" "${kept_header}" "${include}"
      COMMAND "${CMAKE_COMMAND}" -E copy ${headers} "${include}/crankloop")
    foreach(folder IN LISTS folders)
      cmake_path(GET folder FILENAME folder_name)
      list(APPEND commands
        COMMAND "${CMAKE_COMMAND}" -E copy_directory "${folder}" "${include}/crankloop/${folder_name}")
    endforeach()
    if(windows_object)
      list(APPEND commands
        COMMAND "${CMAKE_COMMAND}" -E make_directory "${root}/binaries/${windows_folder_of_${fmi}}"
        COMMAND "${CMAKE_COMMAND}" -E copy "${windows_object}" "${root}/binaries/${windows_folder_of_${fmi}}")
    endif()
    list(APPEND commands COMMAND "${program}" pack "${root}" -o "${fmu}")
    list(APPEND fmus "${fmu}")
  endforeach()
  add_custom_command(OUTPUT ${fmus} ${commands}
    DEPENDS ${name}_fmu ${name}_fmu_files ${windows_object} "${program}" "${kept_header}"
      "${dir}/fmu_sources/${name}.hpp" ${all_headers}
    COMMENT "FMUs of ${name}"
    VERBATIM)
  add_custom_target(${name}_fmus ALL DEPENDS ${fmus})
endfunction()

# A shared object that an importer loads: nothing but FMI's functions is seen from outside, nothing but the C library
# needed from there, and nothing of the building machine is written into it.
function(crankloop_fmu_link target output_name)
  if(WIN32)
    crankloop_windows_link_options(link_options)
    target_link_options(${target} PRIVATE ${link_options})
    set_target_properties(${target} PROPERTIES PREFIX "" SUFFIX .dll OUTPUT_NAME "${output_name}")
    return()
  endif()
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # a sanitizer's functions are in the program that loads it
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  target_link_options(${target} PRIVATE
    -static-libstdc++ -static-libgcc
    -Wl,-Bsymbolic -Wl,--exclude-libs,ALL -Wl,--gc-sections -Wl,--build-id=none -Wl,-s
    "-Wl,--version-script=${CMAKE_CURRENT_FUNCTION_LIST_DIR}/fmu.map")
  set_target_properties(${target} PROPERTIES
    PREFIX "" SUFFIX .so OUTPUT_NAME "${output_name}"
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    SKIP_BUILD_RPATH ON
    LINK_DEPENDS "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/fmu.map")
endfunction()

# What the toolchain files of all bare-metal ports share.
#
#   crankloop_bare_metal(PORT PREFIX FLAGS)   PORT is the folder of port/, PREFIX the compiler's, FLAGS say which processor

macro(crankloop_bare_metal port prefix flags)
  set(CMAKE_SYSTEM_NAME Generic)
  set(CMAKE_SYSTEM_PROCESSOR ${port})
  set(CMAKE_CXX_COMPILER ${prefix}-g++)
  set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # an executable needs the port's linker script
  set(CMAKE_CXX_FLAGS_INIT "${flags}")
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)  # nothing of the building machine is linked
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
  set(CRANKLOOP_PORT ${port} CACHE STRING "Folder of port/ that images link")
  # Text and exit status by semihosting. Text comes on QEMU's standard error.
  set(crankloop_qemu_arguments -nographic -monitor none -serial none -semihosting-config enable=on,target=native)
endmacro()

# crankloop_port(SOURCE...): the target crankloop_port, which an image links for start-up, text, end and counter; and
# the linker script crankloop_linker_script of the calling folder.
function(crankloop_port linker_script)
  add_library(crankloop_port OBJECT ${ARGN})
  target_include_directories(crankloop_port PUBLIC ${crankloop_SOURCE_DIR})
  target_compile_features(crankloop_port PUBLIC cxx_std_17)
  target_compile_options(crankloop_port PUBLIC
    -fno-exceptions -fno-rtti -fno-threadsafe-statics -ffunction-sections -fdata-sections)
  # Start-up before main has no zeroed memory yet, and the compiler must not turn its loops into calls of memset.
  target_compile_options(crankloop_port PRIVATE -fno-tree-loop-distribute-patterns -ffreestanding)
  target_link_options(crankloop_port INTERFACE
    -nostdlib -Wl,--gc-sections -Wl,--fatal-warnings
    -L${crankloop_SOURCE_DIR}/port/common -T${linker_script})
  set_target_properties(crankloop_port PROPERTIES
    INTERFACE_LINK_DEPENDS "${linker_script};${crankloop_SOURCE_DIR}/port/common/sections.ld")
  # libm for sqrt alone: of double, on a processor that has float only.
  target_link_libraries(crankloop_port INTERFACE -lm -lc -lgcc)
  crankloop_warnings(crankloop_port)
endfunction()

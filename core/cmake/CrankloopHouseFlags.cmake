# The flags that crankloop's promises rest on. They are private to the targets they are put on: a user's own code keeps
# its flags.
#
#   crankloop_numerics(TARGET)       same bits everywhere: every target of crankloop's own, tests and program included
#   crankloop_house_flags(TARGET)    the above, and small code without exceptions: the library and every scene
#   crankloop_optimization(TARGET LEVEL)  -O3 or another level, whatever the build type; "project": the build type's
#   crankloop_warnings(TARGET)       what crankloop's own builds (CRANKLOOP_DEVELOPER) treat as errors; nothing for anyone else

if(NOT CMAKE_CXX_COMPILER_LOADED)
  message(FATAL_ERROR "crankloop: needs C++ beside C; let the project begin with project(${PROJECT_NAME} LANGUAGES C CXX)")
endif()
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  message(FATAL_ERROR "crankloop: needs GCC or Clang, whose flags keep a*b+c in two roundings; this is ${CMAKE_CXX_COMPILER_ID}")
endif()

function(crankloop_numerics target)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 17
    CXX_STANDARD_REQUIRED ON
    CXX_EXTENSIONS OFF
    INTERPROCEDURAL_OPTIMIZATION OFF)  # link-time optimisation inlines this code into code that contracts
  target_compile_options(${target} PRIVATE
    -fno-lto              # also where the user's CMAKE_CXX_FLAGS say -flto
    -ffp-contract=off     # a*b+c keeps both its roundings: otherwise every processor with fused multiply-add differs
    -fno-associative-math -fno-reciprocal-math -fsigned-zeros  # as written, not as rearranged
    # As written also in GCC's other respects. To Clang the same words mean that operations may trap: then it folds no
    # constant, and computes at run time, in double, what a float scene writes as a double constant.
    $<$<CXX_COMPILER_ID:GNU>:-fno-unsafe-math-optimizations>
    $<$<NOT:$<CXX_COMPILER_ID:GNU>>:-fno-approx-func>
    -fno-math-errno       # sqrt is one instruction and not a call that may set errno
    # GCC 12's vectoriser of straight-line code makes fused multiply-adds of a pair of sums whatever -ffp-contract says.
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
    # GCC 12 for Arm forgets that a member function writes members of its object and goes on with the values from before
    # the call: at -O2 the torque of scenes with measured pressures lost its inertia. tests/target/golden.cpp sees it.
    $<$<CXX_COMPILER_ID:GNU>:-fno-ipa-modref>
    # Of a store whose address its loop optimiser has written as 0 plus the rest GCC 12 believes that it traps, and of
    # its function that it does nothing else: at -O3 on x86-64 no valve learnt where its cam is, and `crankloop bench
    # --kernel 8-valves-float` fell over.
    $<$<CXX_COMPILER_ID:GNU>:-fno-ipa-pure-const>)
endfunction()

function(crankloop_house_flags target)
  crankloop_numerics(${target})
  target_compile_options(${target} PRIVATE
    -fno-exceptions
    -fno-rtti
    -fno-threadsafe-statics
    -ffunction-sections   # what a firmware image does not use,
    -fdata-sections)      # its linker can leave out
endfunction()

function(crankloop_optimization target level)
  if(NOT level STREQUAL project)
    target_compile_options(${target} PRIVATE ${level})  # behind the build type's, and the last one counts
  endif()
endfunction()

function(crankloop_warnings target)
  if(CRANKLOOP_DEVELOPER)
    target_compile_options(${target} PRIVATE
      -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Werror)
  endif()
endfunction()

# cmake -D WHOLE=whole.wasm -D OUTPUT=FOLDER -P double_part.cmake: engine.wasm, which a page starts, and
# engine_double.wasm, the functions that only arithmetic in double needs. Both have one memory and one table; an import of
# "placeholder" stands for each function that the second has. WHOLE has the names of its functions, as they are mangled.
find_program(WASM_OPT wasm-opt REQUIRED)
find_program(WASM_SPLIT wasm-split REQUIRED)
find_program(NODE NAMES node nodejs REQUIRED)
set(features --enable-bulk-memory --enable-exception-handling --enable-mutable-globals --enable-nontrapping-float-to-int
  --enable-sign-ext)
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status ERROR_VARIABLE errors OUTPUT_QUIET)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${errors}")
  endif()
endfunction()

set(calls ${WHOLE}.calls)
execute_process(COMMAND ${WASM_OPT} ${features} ${WHOLE} --print-call-graph -o ${WHOLE}.same OUTPUT_FILE ${calls}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/double_part.mjs ${calls} OUTPUT_FILE ${WHOLE}.double
  COMMAND_ERROR_IS_FATAL ANY)
run(${WASM_SPLIT} ${features} ${WHOLE} --split-funcs=@${WHOLE}.double --import-namespace=primary
  --placeholder-namespace=placeholder -o1 ${WHOLE}.first -o2 ${WHOLE}.second)
file(MAKE_DIRECTORY ${OUTPUT})
# At -O3 a tick is 3 to 9 % faster than at -Oz; with functions of more than 16 instructions inlined, the first is 25 kB more.
set(for_speed -O3 --low-memory-unused --strip-debug --strip-producers)
run(${WASM_OPT} ${features} ${for_speed} --flexible-inline-max-function-size=16 ${WHOLE}.first -o ${OUTPUT}/engine.wasm)
run(${WASM_OPT} ${features} ${for_speed} ${WHOLE}.second -o ${OUTPUT}/engine_double.wasm)

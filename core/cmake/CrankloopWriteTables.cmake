# Run by crankloop_add_scene's build rule: has the program print an engine's tables, and puts them in place only when complete, so that
# neither a refused engine file nor an interrupted build leaves half a header behind.
#
# Takes program, engine_file, tick_us, real, output.

set(unfinished "${output}.unfinished")
execute_process(
  COMMAND "${program}" tables "${engine_file}" --tick-us "${tick_us}" --real "${real}"
  OUTPUT_FILE "${unfinished}"
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  file(REMOVE "${unfinished}")
  message(FATAL_ERROR "crankloop tables ${engine_file}: ended with ${status}")
endif()
file(RENAME "${unfinished}" "${output}")

# cmake -D OUTPUT=golden_files.hpp -D ENGINES=tools/engines -P golden_files.cmake: the golden runs' engine files as texts.
set(code "// Made by golden_files.cmake; do not edit.\n#pragma once\n")
foreach(pair IN ITEMS kDiesel495:diesel_495 kOhc125:ohc_125 kFour2000:four_2000)
  string(REGEX MATCH "^[^:]+" constant ${pair})
  string(REGEX MATCH "[^:]+$" name ${pair})
  file(READ ${ENGINES}/${name}.ini text)
  string(APPEND code "inline constexpr const char* ${constant} = R\"text(${text})text\";\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${code}" @ONLY)

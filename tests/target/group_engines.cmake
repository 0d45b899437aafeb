# Engines that each ask for one group of results or one part of the gas more than ElasticValves or Fired of scenes.hpp: what they cost beside
# those is the group's cost, on targets (CMakeLists.txt here) and on a host (../contract/figures).
#
# for_each_group_engine(FUNCTION VALVES_FILE GAS_FILE): calls FUNCTION(NAME SCENE ENGINE_FILE), the file made from one of both.
function(for_each_group_engine call valves_file gas_file)
  # group(NAME SCENE FILE SECTION KEYS): all sections of this name have KEYS besides; "": KEYS stand at the end.
  function(group name scene file section keys)
    file(READ ${file} text)
    if(section)
      string(REGEX REPLACE "(\n\\[${section}[^]]*\\]\n)" "\\1${keys}\n" text "${text}")
    else()
      string(APPEND text "\n${keys}\n")
    endif()
    set(made ${CMAKE_CURRENT_BINARY_DIR}/${name}.ini)
    file(CONFIGURE OUTPUT ${made} CONTENT "${text}" @ONLY)
    cmake_language(CALL ${call} ${name} ${scene} ${made})
    set(costs_engines ${costs_engines} PARENT_SCOPE)
  endfunction()
  group(SurgingValves SurgingValves ${valves_file} valve "surge_modes = 2")
  group(CamContactValves CamContactValves ${valves_file} cam "width_mm = 10")
  group(CamTorqueValves CamTorqueValves ${valves_file} cam "friction_ratio = 0.08")
  group(FiredCrevice FiredCrevice ${gas_file} gas "crevice_share = 0.015")
  group(FiredBlowBy FiredCrevice ${gas_file} gas "crevice_share = 0.015\nblow_by_mm2 = 0.1")
  group(FiredRunners FiredRunners ${gas_file} gas
    "intake_runner_mm = 400\nintake_runner_diameter_mm = 38\nexhaust_runner_mm = 500\nexhaust_runner_diameter_mm = 36")
  group(FiredWalls FiredWalls ${gas_file} gas "wall_J_per_K = 1500\nwall_W_per_K = 20\ncoolant_C = 90")
  group(FiredKnock FiredKnock ${gas_file} gas "octane = 95")
  group(FiredChargeBurn FiredChargeBurn ${gas_file} gas "burn_by = charge")
  group(FiredLambda FiredLambda ${gas_file} "" "[lambda_sensor]\npipe_cm3 = 500\nlag_s = 0.05")
  group(FiredSensors FiredSensors ${gas_file} "" "[sensor_fault map]\nsensor = map\nend_s = 1000\noffset = 500\nnoise = 200\ndelay_s = 0.01\nlag_s = 0.005\nleast = 10000\nmost = 120000\nstep = 100")
  set(costs_engines ${costs_engines} PARENT_SCOPE)
endfunction()

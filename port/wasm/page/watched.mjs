// Which of an engine's channels the page shows: all cylinders' pressure, and one cylinder's valves.

const kOfEngine = ['speed_rad_s', 'torque_Nm', 'mean_torque_Nm', 'faults', 'intake.pressure_Pa',
                   'exhaust.pressure_Pa'];
const kOfValve = ['theoretical_lift_m', 'lift_m', 'velocity_m_s'];
const kOfValveForces = ['regime', 'train_N', 'seat_N', 'cam_N'];

/// names: of all channels; those of them that are watched while `cylinder` is shown, counted from 1.
export function watchedOf(names, cylinder) {
  const has = new Set(names);
  const gas = has.has('cylinder_gas[1].pressure_Pa');
  const wanted = [...kOfEngine];
  for (let k = 1; has.has(pressureName(k, gas)); ++k) wanted.push(pressureName(k, gas));
  wanted.push(`cylinder[${cylinder}].torque_Nm`, `cylinder[${cylinder}].side_force_N`);
  if (gas) wanted.push(`cylinder_gas[${cylinder}].temperature_K`);
  for (let t = 1; has.has(`valve[${t},${cylinder}].lift_m`); ++t) {
    kOfValve.forEach((name) => wanted.push(`valve[${t},${cylinder}].${name}`));
    kOfValveForces.forEach((name) => wanted.push(`valve_forces[${t},${cylinder}].${name}`));
  }
  return wanted.filter((name) => has.has(name));
}

export function pressureName(cylinder, gas) {
  return gas ? `cylinder_gas[${cylinder}].pressure_Pa` : `cylinder[${cylinder}].pressure_Pa`;
}

// What the README takes for granted: the user's own functions.
#pragma once

#include <cstdint>

float crank_speed();
void set_torque(float torque_Nm);
void report(std::uint32_t faults);
void every_100_us();

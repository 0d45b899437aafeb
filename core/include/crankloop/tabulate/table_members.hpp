// The members of each record of the tables, for code that visits a whole table: to print it, to round it.
//
// What belongs here: members(record), all of them as a tuple of references. By structured binding, so that a record
// whose member is forgotten here does not compile: no member can be silently zero in flash. What does not: their
// meaning (tables/records.hpp and the headers beside it).
#pragma once

#include <tuple>

#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

#define CRANKLOOP_TIED(Prefix, Record, ...)                     \
  Prefix [[nodiscard]] constexpr auto members(Record& record) { \
    auto& [__VA_ARGS__] = record;                               \
    return std::tie(__VA_ARGS__);                               \
  }
#define CRANKLOOP_MEMBERS(Record, ...) CRANKLOOP_TIED(, Record, __VA_ARGS__) CRANKLOOP_TIED(, const Record, __VA_ARGS__)
#define CRANKLOOP_MEMBERS_OF(Record, ...)                          \
  CRANKLOOP_TIED(template <class Real>, Record<Real>, __VA_ARGS__) \
  CRANKLOOP_TIED(template <class Real>, const Record<Real>, __VA_ARGS__)

CRANKLOOP_MEMBERS(CylinderGroups, cylinder, end)
CRANKLOOP_MEMBERS_OF(Drive, fingerprint, tick, per_tick, cycles_per_tick, speed_per_cycle, speed_limit, cylinders,
                     mechanisms, firing_phase, mechanism_of, turn_of, by_mechanism, trains, modes)
CRANKLOOP_MEMBERS_OF(Body, radius, per_radius, per_rod, offset, height, area, crankcase, mass, inertia)
CRANKLOOP_MEMBERS_OF(Segment, c)
CRANKLOOP_MEMBERS_OF(IntegralSegment, c)
CRANKLOOP_MEMBERS_OF(IntegratedSegment, base, slope)
CRANKLOOP_MEMBERS_OF(IntegratedCurve, quantum, at)
CRANKLOOP_MEMBERS_OF(Revolution, at)
CRANKLOOP_MEMBERS_OF(MotionSegment, displacement, slope, acceleration)
CRANKLOOP_MEMBERS_OF(LeanSegment, tilt, radial)
CRANKLOOP_MEMBERS_OF(RodSegment, angle, slope)
CRANKLOOP_MEMBERS(GasGrid, first)
CRANKLOOP_MEMBERS_OF(GasTorque, at, quantum, mean)
CRANKLOOP_MEMBERS_OF(CrankDynamics, turning, least, drag, drag_linear, drag_quadratic, stall, starter_slope, most)
CRANKLOOP_MEMBERS_OF(Bearings, pins, pin_of, by_pin, rods, throws, cosines, sines)
CRANKLOOP_MEMBERS_OF(RotatingVector, up_cos, up_sin, lateral_cos, lateral_sin, pitch_cos, pitch_sin, yaw_cos, yaw_sin)
CRANKLOOP_MEMBERS_OF(Balance, first, second, rotating, cosine)
CRANKLOOP_MEMBERS_OF(LiftSegment, c)
CRANKLOOP_MEMBERS_OF(LiftCurve, at, rocker_ratio, opens, most_phase, segments, touch_from, touch_degrees, leap, outside)
CRANKLOOP_MEMBERS(CamDegrees, cylinders)
CRANKLOOP_MEMBERS_OF(ValveBody, mass, train, train_damping, seat, seat_damping, spring, guide, preload,
                     seat_compression, head_area, rocker_mass, per_mass)
CRANKLOOP_MEMBERS_OF(StepRow, rest, gas, gas_rise, gap, rise, from, to, lift, velocity)
CRANKLOOP_MEMBERS_OF(ForceRow, rest, gas, lift, velocity, gap, gap_speed)
CRANKLOOP_MEMBERS_OF(ContactGuard, sign, lag, least)
CRANKLOOP_MEMBERS_OF(MiddleStep, lift, velocity)
CRANKLOOP_MEMBERS_OF(RegimeStep, lift, velocity, acceleration, train, seat, rest, rest_speed, middle, calm)
CRANKLOOP_MEMBERS_OF(RegimeSeries, rest, gas, stiffness, damping, lift, lift_speed)
CRANKLOOP_MEMBERS_OF(ValveMotion, body, tick, fine, per_fine, per_parts, parts, per_parts_32, changes, cubic, widest,
                     train_lag, seat_lag, per_seat, quiet, seat_rate, whole_steps, fine_steps, series)
CRANKLOOP_MEMBERS_OF(ModeRow, q, v, drive)
CRANKLOOP_MEMBERS_OF(ModeStep, of_q, of_v, push)
CRANKLOOP_MEMBERS_OF(ValveSprings, modes, mode)
CRANKLOOP_MEMBERS_OF(CamContactSegment, stress, entrainment)
CRANKLOOP_MEMBERS_OF(CamContactCurve, at, sliding, per_width)
CRANKLOOP_MEMBERS_OF(CamTorqueTable, sliding, friction, cams)
CRANKLOOP_MEMBERS_OF(GasWalls, factor, area, per_volume, temperature, piston)
CRANKLOOP_MEMBERS_OF(GasCylinders, walls, clearance, bore_area, crankcase, least, per_swept, per_charge, ambient,
                     ambient_temperature, exhaust_temperature, steps, parts)
CRANKLOOP_MEMBERS_OF(GasCrevice, per_Pa, wall, specific_work, energy, burned_more, leak, crankcase, in_use)
CRANKLOOP_MEMBERS_OF(GasRunner, area, per_length, loss, per_volume, least)
CRANKLOOP_MEMBERS_OF(GasRunners, of)
CRANKLOOP_MEMBERS_OF(GasPortCurve, port, per_step, area)
CRANKLOOP_MEMBERS_OF(GasBeyond, pressure, choked, specific_work, enthalpy, burned, response, end, others)
CRANKLOOP_MEMBERS_OF(GasManifolds, parts, spare, per_volume, least, outside, outlet, throttle)
CRANKLOOP_MEMBERS_OF(BurnTable, latch, energy, heat, burning, burned, air_fuel, per_air_fuel, span, fuel, excess_air,
                     start, duration, burnt)
CRANKLOOP_MEMBERS_OF(ChargeBurnTable, reference, delay, in_use, spare)
CRANKLOOP_MEMBERS_OF(WarmWallsTable, capacity, to_coolant, coolant, port, behind, ticks, of_ports)
CRANKLOOP_MEMBERS_OF(KnockTable, rate, hot, in_use, spare)
CRANKLOOP_MEMBERS_OF(LambdaTable, air_fuel, burned, unburned, pipes, follows, in_use, spare)
CRANKLOOP_MEMBERS_OF(MisfireRule, burning, pattern, misfires, of, below, seed, listed, cycle)
CRANKLOOP_MEMBERS(TriggerTrack, edges, edge_count, on_crank, starts, train, inverted, max_edges, edges_before)
CRANKLOOP_MEMBERS(TriggerWheels, wheel, count)
CRANKLOOP_MEMBERS_OF(WheelFaultRule, track, from, until, wheel, mask, inverted, stuck, below, seed, pulse)
CRANKLOOP_MEMBERS_OF(WheelFaultRules, fault, count)
CRANKLOOP_MEMBERS_OF(ReluctorCell, c)
CRANKLOOP_MEMBERS_OF(ReluctorTable, starts, on_crank, in_use, watchdog, cells, arm, least, hysteresis, delay, at)
CRANKLOOP_MEMBERS_OF(SensorFaultRule, from, until, sensor, mask, wire, seed, samples, ticks, follows, offset, noise,
                     least, most, step, per_step, spare)
CRANKLOOP_MEMBERS_OF(SensorFaultRules, fault, count, spare)

#undef CRANKLOOP_TIED
#undef CRANKLOOP_MEMBERS
#undef CRANKLOOP_MEMBERS_OF

}  // namespace crankloop::detail

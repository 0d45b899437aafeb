/* The engine as a WebAssembly module: what a page calls.
 *
 * What belongs here: the module's exports, and what their texts and numbers mean. What does not: how they are computed
 * (module.cpp and its neighbours), what a page makes of them (page/).
 *
 *     page_put_file("pressure_495.csv", ...);            tables that the engine file names
 *     page_load("diesel_495.ini", ...);                  read and checked by the program's own reader
 *     page_start(50, 0, 0, 2000, 0);                     tick in us, float, speed held at 2000 rpm, crank at 0 deg
 *     page_watch("torque_Nm\ncylinder[1].pressure_Pa");  what a sample has beside time and angle
 *     page_step(1000, 1);                                1000 ticks, a sample of each
 *
 * Texts in are UTF-8 with their size in bytes, in room from page_take(). Texts out are JSON in UTF-8, ended by a NUL;
 * a text stays until the next call that answers one. Numbers in JSON are the shortest that read back as the same
 * double; what is not finite is null. Pointers to numbers may move with each call, as the memory's buffer does when it
 * grows: make views anew after a call.
 *
 * No function throws, and none changes anything when it answers errors: the engine that was loaded, or that ran,
 * goes on. A "message" is {"line": 12, "text": "four_2000.ini:12: ..."}; line is of the engine file, 0 where the
 * message names another file or none; text is what the program prints, and has one line. Text from a file is text:
 * never put it into a page as markup.
 *
 * The module wants two imports, neither of which does anything of use to it:
 *     env.emscripten_notify_memory_growth(index)
 *     wasi_snapshot_preview1.proc_exit(status)           of a defect: throw
 * Call its export _initialize() once, first. One instance is one engine, for one worker; the redline's search runs
 * beside it in another instance.
 *
 * The golden runs are a module of their own, a program for WASI (../module/golden.cpp). It writes lines "golden NAME
 * 0xHASH" and last "N passed, M failed".
 */
#ifndef CRANKLOOP_PORT_WASM_PAGE_MODULE_H
#define CRANKLOOP_PORT_WASM_PAGE_MODULE_H

#include <stdint.h>

#if defined(__wasm__)
#define PAGE_EXPORT(name) __attribute__((export_name(#name))) name
#else
#define PAGE_EXPORT(name) name
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- memory ---- */

/** Room for a text or table; null: none left. Give it back when the call that takes it has returned. */
char* PAGE_EXPORT(page_take)(uint32_t bytes);
void PAGE_EXPORT(page_give)(char* room);

/** {"version": "0.3.0", "simd": true, "max_samples": 262144} */
const char* PAGE_EXPORT(page_facts_of_module)(void);

/* ---- an engine file ---- */

/** A file beside the engine file, by the name that the engine file has for it ("pressure_495.csv", "cams/in.csv").
 *  Replaces one of that name. */
void PAGE_EXPORT(page_put_file)(const char* name, uint32_t name_bytes, const char* text, uint32_t bytes);
/** Forgets all of them. The engine that is loaded keeps what it read. */
void PAGE_EXPORT(page_forget_files)(void);

/** Reads and checks the text, as `crankloop run` does; warnings are those that it prints.
 *  {"errors": [message...], "warnings": [message...]}; loaded where errors is empty. What runs goes on with the engine
 *  from before until page_start(). */
const char* PAGE_EXPORT(page_load)(const char* name, uint32_t name_bytes, const char* text, uint32_t bytes);

/** What the engine is, for drawing; lengths in m, angles in deg of the crank.
 *  {"name", "path", "breathes": true, "has_pressure": true, "has_starter": true, "has_triggers": true,
 *   "rated_rpm": 5500, "max_rpm": 7000 or null,
 *   "crank": {"bore_m", "crank_radius_m", "rod_length_m", "pin_offset_m", "compression_ratio", "stroke_m" (true one),
 *             "swept_m3", "clearance_m3" (volumes of one cylinder)},
 *   "cylinders": [{"firing_deg", "bank_deg", "position_m", "pin" (from 0), "throw_deg" (of its crank pin from the
 *                  vertical at crank angle 0)}...],
 *   "firing_order": [1, 3, 4, 2],
 *   "trains": [{"name", "port": "intake"|"exhaust"|"", "valves_per_cylinder", "max_lift_m", "full_lift_deg" (in the
 *               cylinder's own cycle), "opens_deg", "closes_deg" (own cycle, may be below 0 or above 720),
 *               "rocker": "circular_pad"|"ratio", "base_circle_m", "clearance_m", "seat_m" (diameter, 0 unknown),
 *               "cam_deg": [-180 ... 180], "cam_lift_m": [...] (the valve's lift as the cam wants it, not below 0; cam
 *               angle from full lift, every degree), "profile_m": [...] (base circle and lift of a flat follower, at
 *               the same angles of the follower)}...],
 *   "wheels": [{"name", "shaft": "crank"|"cam", "places", "inverted", "rising_deg": [...], "falling_deg": [...] (edges
 *               in a turn of its shaft, crank degrees, may pass the turn's end)}...]}
 *  {} where none is loaded. */
const char* PAGE_EXPORT(page_facts)(void);

/** Keys that the file's sections have, with their values, also defaults.
 *  [{"key": "valve.intake.spring_N_per_mm", "section": "valve", "name": "intake", "unit": "N/mm", "kind": "number"|
 *    "whole_number"|"numbers"|"pairs"|"choice"|"text"|"path"|"firing_order"|"pin_groups", "choices": ["table", ...],
 *    "least": 0, "most": 1000, "without_least": false, "without_most": false (least and most: null without a limit),
 *    "value": "32.5", "line": 40 (0: a default), "used": true (false: of a form that is not chosen), "meaning"}...] */
const char* PAGE_EXPORT(page_keys)(void);

/* ---- the engine runs ---- */

/** Makes the loaded engine's tables and starts it: from the crank angle, at the speed, valves at rest on their seats,
 *  manifolds at ambient. Speed held: the tick of `crankloop run`; crank free: of `run --free`. Time and cycles begin at
 *  0. Inputs begin at the values of the file; the speed is an input then. What page_watch() asked for stays asked for.
 *  {"errors": [message...], "warnings": [message...] (but for a tick too long for a valve's class: that takes seconds),
 *   "settling_cycles": 1, "ticks_per_cycle": 1200.0 (at that
 *   speed, null at rest)} */
const char* PAGE_EXPORT(page_start)(double tick_us, uint32_t in_double, uint32_t crank_is_free, double speed_rpm,
                                    double crank_deg);

/** The running engine's inputs: [{"name": "throttle_ratio", "base": "throttle_ratio", "index": 0 (from 1 of
 *   "fuel_kg[2]"), "unit": "1", "shown_unit": "", "shown_per_unit": 1, "kind": "real"|"whole"|"truth", "least", "most",
 *   "meaning"}...]. Of speed held "speed_rad_s"; of a free crank "external_torque_Nm", "starter"; with a diagram
 *  "load_ratio"; with gas "throttle_ratio", "fuel_kg[#]", "excess_air_ratio[#]" (lambda; above 0 it counts and the fuel
 *  does not), "burn_start_deg[#]", ...; "cut_cylinders" (bit k: cylinder k+1 does not fire), "wheel_faults". */
const char* PAGE_EXPORT(page_inputs)(void);
/** As many doubles as page_inputs() has, in its order. Write into them; every tick reads them. */
double* PAGE_EXPORT(page_input_values)(void);

/** All that a sample may have: [{"name": "valve[1,2].lift_m", "base": "valve[#,#].lift_m", "first": 1, "second": 2
 *   (indices from 1, 0: none; of a valve train and cylinder), "unit": "m", "shown_unit": "mm", "shown_per_unit": 1000,
 *   "kind", "meaning"}...]. Of note, of each cylinder k and train t:
 *     time_s, crank_deg (0 to below 720), speed_rad_s, torque_Nm, mean_torque_Nm, faults (bits)
 *     displacement_m[k] (piston from top dead centre), cylinder[k].pressure_Pa, cylinder[k].torque_Nm, .side_force_N
 *     valve[t,k].theoretical_lift_m (wanted), .lift_m, .velocity_m_s, .acceleration_m_s2
 *     valve_forces[t,k].regime (0 free, 1 on its train, 2 on its seat, 3 on both), .train_N, .seat_N, .cam_N
 *     trigger[w].level, faulty_trigger[w].level, intake.pressure_Pa, cylinder_gas[k].temperature_K */
const char* PAGE_EXPORT(page_channels)(void);

/** What a sample has from now on, beside time_s and crank_deg, which come first: names of page_channels(), each ended
 *  by a line feed but the last; "" none. Answers {"errors": [message...], "columns": ["time_s", "crank_deg", ...]}. A
 *  name that the running engine lacks is an error, and the columns stay; after page_start() names that the new engine
 *  lacks are left out, and page_columns() says what is left. */
const char* PAGE_EXPORT(page_watch)(const char* names, uint32_t bytes);
const char* PAGE_EXPORT(page_columns)(void); /**< ["time_s", "crank_deg", ...] */

/** Runs so many ticks, or fewer where the room for samples is full: the answer. A sample is taken after each `every`th
 *  tick since page_start(); 0: none. */
uint32_t PAGE_EXPORT(page_step)(uint32_t ticks, uint32_t every);
/** Samples of the last page_step(), and how many. Row-major doubles: sample r's column c is at [r * columns + c]. */
const double* PAGE_EXPORT(page_samples)(void);
uint32_t PAGE_EXPORT(page_sample_count)(void);
/** The last tick's values in the same columns, whatever `every` was. */
const double* PAGE_EXPORT(page_now)(void);

/** Edges of the trigger wheels in the last page_step(), also between samples: rows of three doubles, time_s, wheel
 *  (from 0; that of faulty signals plus 100 where faults of wheels are on), level after it (0 or 1). Up to 4096; what
 *  did not fit is not there, and page_edges_lost() counts it. */
const double* PAGE_EXPORT(page_edges)(void);
uint32_t PAGE_EXPORT(page_edge_count)(void);
uint32_t PAGE_EXPORT(page_edges_lost)(void);

/** Whole cycles of 720 deg since page_start(). */
uint32_t PAGE_EXPORT(page_cycles)(void);
/** Results of the last whole cycle: [{"name": "net_mep_Pa", "base", "first", "second", "unit", "shown_unit",
 *   "shown_per_unit", "meaning", "of": "engine"|"cylinder"|"valve"}...]; mean torque, power, net mean pressure, speed
 *  (mean, least, largest), largest pressure and where of each cylinder, the valves' separations, bounces, seating
 *  speeds ..., the gas's volumetric efficiency, residual gas, fuel, heat .... */
const char* PAGE_EXPORT(page_results)(void);
/** As many doubles, in that order; not a number before the first cycle is whole. */
const double* PAGE_EXPORT(page_result_values)(void);

/* ---- proof ---- */

/** As `crankloop run FILE --hash --rpm N --tick-us T --cycles C --real R` of the loaded file: the hash of every bit
 *  that comes out. Does not touch what runs. {"errors": [...], "hash": "0x0123456789ABCDEF", "ticks": 2400} */
const char* PAGE_EXPORT(page_hash)(double tick_us, uint32_t in_double, double speed_rpm, uint32_t cycles);
/** As `crankloop run FILE --free --hash --from-rpm N --tick-us T --seconds S --real R` of the loaded file. Does not
 *  touch what runs. Answers as page_hash() does. */
const char* PAGE_EXPORT(page_hash_free)(double tick_us, uint32_t in_double, double speed_rpm, double seconds);

/* ---- the redline ---- */

/** Begins the search of `crankloop redline FILE --train TRAIN`: a sweep of speeds, then the onsets to 1 rpm. to_rpm 0:
 *  what `redline` takes. {"errors": [...], "from_rpm", "to_rpm", "step_rpm", "speeds": 61 (of the sweep),
 *  "static_redline_rpm" (null: none), "tick_us"} */
const char* PAGE_EXPORT(page_redline)(const char* train, uint32_t bytes, uint32_t from_rpm, uint32_t to_rpm);

/** Runs one speed more, some milliseconds.
 *  {"ended": false, "part": "sweep"|"separation"|"bounce"|"seating", "done": 12, "of": 75 (an estimate),
 *   "speed_rpm": 6200, "results": {"max_lift_m", "separations", "separation_gap_m", "seating_m_s", "bounces",
 *   "bounce_m", "max_acceleration_m_s2", "train_N", "cam_N", "spring_margin", "is_possible"}}
 *  When ended, the onsets: {"ended": true, "separation_rpm", "bounce_rpm", "seating_rpm" (null: none in the range),
 *   "separation_at_start", "bounce_at_start", "seating_at_start"}. */
const char* PAGE_EXPORT(page_redline_step)(void);

#ifdef __cplusplus
}
#endif

#endif

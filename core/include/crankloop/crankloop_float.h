/* Tables and engine in float: included by crankloop.h, which has what they are made of.
 *
 * crankloop_double.h is this file with float, _f_ and _F_ replaced (tests/contract/c_headers_agree.sh): edit this one.
 */
#ifndef CRANKLOOP_CRANKLOOP_FLOAT_H
#define CRANKLOOP_CRANKLOOP_FLOAT_H

#include <crankloop/crankloop.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- tables: made once, read by any number of engines --------------------------------------------------------------------------- */

/* Must be zero before it is created, as static objects are. Large: not for a stack. Must not be moved or copied. */
typedef struct crankloop_f_tables {
  uint64_t opaque[CRANKLOOP_F_TABLES_WORDS];
} crankloop_f_tables;

/* Some 100 ms on a desktop, at most some seconds (docs/contract.md "Complexity and memory"), and up to 80 kB of stack. Refuses a bad
   definition and says which field. */
CRANKLOOP_API crankloop_status crankloop_f_tables_create(crankloop_f_tables *tables, size_t tables_size,
                                                         const crankloop_definition *definition, size_t definition_size,
                                                         const crankloop_options *options, size_t options_size);

/* Makes the memory free for another create. Engines on these tables then answer CRANKLOOP_FAULT_NOT_READY, and also on new tables that are
   created there, until they are reset; the memory itself must stay. */
CRANKLOOP_API crankloop_status crankloop_f_tables_discard(crankloop_f_tables *tables);

/* ---- engine --------------------------------------------------------------------------------------------------------------------- */

/* Must be zero before it is created. May be copied: the copy goes on by itself. */
typedef struct crankloop_f_engine {
  uint64_t opaque[CRANKLOOP_F_ENGINE_WORDS];
} crankloop_f_engine;

/* At rest at a phase: 2^64 = one cycle of 720 deg, 0 = cylinder 1's firing top dead centre. The tables must outlive the engine. */
CRANKLOOP_API crankloop_status crankloop_f_engine_create(crankloop_f_engine *engine, size_t engine_size, const crankloop_f_tables *tables,
                                                         uint64_t start_phase);
CRANKLOOP_API crankloop_status crankloop_f_engine_discard(crankloop_f_engine *engine);

/* As newly created, on the same tables. */
CRANKLOOP_API crankloop_status crankloop_f_engine_reset(crankloop_f_engine *engine, uint64_t start_phase);

typedef struct crankloop_f_input {
  float speed_rad_s;                            /* negative = backwards */
  float load_ratio;                             /* 0 = motored, 1 = the diagram as given; 0 to 2; default 1 */
  float cam_phase_deg[CRANKLOOP_MOST_TRAINS];   /* target, crank degrees later than defined; default 0 */
} crankloop_f_input;

CRANKLOOP_API crankloop_status crankloop_f_input_defaults(crankloop_f_input *input, size_t size);

/* Advances by one tick and answers its fault bits, 0 = all well. Whatever bits come in, outputs are defined and finite. Bounded work.
   CRANKLOOP_FAULT_NOT_READY: no engine, no tables or no input; nothing was done. */
CRANKLOOP_API uint32_t crankloop_f_step(crankloop_f_engine *engine, const crankloop_f_input *input, size_t input_size);

CRANKLOOP_API uint64_t crankloop_f_phase(const crankloop_f_engine *engine); /* where the crank is; 0 without an engine */

/* ---- what the last step gave, group by group; only the first `cylinders` (trains, pins) of an array are in use -------------------- */

typedef struct crankloop_f_torque {
  float torque_Nm;      /* at the end of the tick */
  float mean_torque_Nm; /* averaged over the angle turned in the tick */
} crankloop_f_torque;
CRANKLOOP_API crankloop_status crankloop_f_read_torque(const crankloop_f_engine *engine, crankloop_f_torque *out, size_t size);

typedef struct crankloop_f_kinematics { /* of each piston, positive toward the crankshaft, from top dead centre */
  float displacement_m[CRANKLOOP_MOST_CYLINDERS];
  float velocity_m_s[CRANKLOOP_MOST_CYLINDERS];
  float acceleration_m_s2[CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_kinematics;
CRANKLOOP_API crankloop_status crankloop_f_read_kinematics(const crankloop_f_engine *engine, crankloop_f_kinematics *out, size_t size);

typedef struct crankloop_f_rod_motion {
  float rod_angle_rad[CRANKLOOP_MOST_CYLINDERS];
  float rod_speed_rad_s[CRANKLOOP_MOST_CYLINDERS];
  float rod_acceleration_rad_s2[CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_rod_motion;
CRANKLOOP_API crankloop_status crankloop_f_read_rod_motion(const crankloop_f_engine *engine, crankloop_f_rod_motion *out, size_t size);

typedef struct crankloop_f_cylinder_forces {
  float pressure_Pa; /* absolute */
  float gas_force_N;
  float inertia_force_N;
  float total_force_N;
  float side_force_N;       /* on the cylinder wall */
  float rod_force_N;        /* along the rod */
  float radial_force_N;     /* at the crank pin, positive toward the crank centre */
  float tangential_force_N; /* at the crank pin, positive with the rotation */
  float torque_Nm;
  float tilting_moment_Nm;
} crankloop_f_cylinder_forces;
typedef struct crankloop_f_forces {
  crankloop_f_cylinder_forces cylinder[CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_forces;
CRANKLOOP_API crankloop_status crankloop_f_read_forces(const crankloop_f_engine *engine, crankloop_f_forces *out, size_t size);

typedef struct crankloop_f_bearing_loads {
  float pin_radial_N[CRANKLOOP_MOST_CYLINDERS];
  float pin_tangential_N[CRANKLOOP_MOST_CYLINDERS];
  float pin_load_N[CRANKLOOP_MOST_CYLINDERS];
  float journal_along_N[CRANKLOOP_MOST_CYLINDERS + 1];
  float journal_across_N[CRANKLOOP_MOST_CYLINDERS + 1];
  float journal_load_N[CRANKLOOP_MOST_CYLINDERS + 1];
} crankloop_f_bearing_loads;
CRANKLOOP_API crankloop_status crankloop_f_read_bearing_loads(const crankloop_f_engine *engine, crankloop_f_bearing_loads *out, size_t size);

typedef struct crankloop_f_free_force {
  float up_N;
  float lateral_N;
  float pitch_Nm;
  float yaw_Nm;
} crankloop_f_free_force;
typedef struct crankloop_f_free_forces {
  crankloop_f_free_force first;
  crankloop_f_free_force second;
  crankloop_f_free_force rotating;
} crankloop_f_free_forces;
CRANKLOOP_API crankloop_status crankloop_f_read_free_forces(const crankloop_f_engine *engine, crankloop_f_free_forces *out, size_t size);

typedef struct crankloop_f_valve_motion {
  float theoretical_lift_m;
  float lift_m;
  float velocity_m_s;
  float acceleration_m_s2;
} crankloop_f_valve_motion;
typedef struct crankloop_f_valves {
  crankloop_f_valve_motion valve[CRANKLOOP_MOST_TRAINS][CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_valves;
CRANKLOOP_API crankloop_status crankloop_f_read_valves(const crankloop_f_engine *engine, crankloop_f_valves *out, size_t size);

typedef struct crankloop_f_valve_force {
  float train_N;
  float seat_N;
  float tip_N;
  float cam_N;
  float gap_m;
  uint32_t regime; /* 0 free, 1 train, 2 seat, 3 both */
} crankloop_f_valve_force;
typedef struct crankloop_f_valve_forces {
  crankloop_f_valve_force valve_forces[CRANKLOOP_MOST_TRAINS][CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_valve_forces;
CRANKLOOP_API crankloop_status crankloop_f_read_valve_forces(const crankloop_f_engine *engine, crankloop_f_valve_forces *out, size_t size);

typedef struct crankloop_f_valve_cycle { /* angles are cam degrees since the start of the lobe */
  float largest_lift_m;
  float largest_speed_m_s;
  float largest_acceleration_m_s2;
  float opening_delay_deg;
  float separation_gap_m;
  float separation_start_deg;
  float separation_duration_deg;
  float seating_speed_m_s;
  float bounce_height_m;
  uint32_t separations;
  uint32_t bounces;
  uint32_t contact_changes;
  uint32_t off_seat_at_end;
} crankloop_f_valve_cycle;
typedef struct crankloop_f_valve_results { /* of the last whole cycle */
  crankloop_f_valve_cycle valve_cycle[CRANKLOOP_MOST_TRAINS][CRANKLOOP_MOST_CYLINDERS];
} crankloop_f_valve_results;
CRANKLOOP_API crankloop_status crankloop_f_read_valve_results(const crankloop_f_engine *engine, crankloop_f_valve_results *out, size_t size);

typedef struct crankloop_f_bad_inputs { /* since the engine was created or reset; of its state, so a restored engine goes on from there */
  uint32_t ticks; /* with a bad input; stays at its largest value */
  uint32_t kinds; /* their CRANKLOOP_FAULT bits, or-ed */
} crankloop_f_bad_inputs;
CRANKLOOP_API crankloop_status crankloop_f_read_bad_inputs(const crankloop_f_engine *engine, crankloop_f_bad_inputs *out, size_t size);

/* ---- state: snapshots within a run of the program, bytes for longer -------------------------------------------------------------- */

typedef struct crankloop_f_snapshot {
  uint64_t opaque[CRANKLOOP_F_SNAPSHOT_WORDS];
} crankloop_f_snapshot;

/* Restored, an engine goes on with the same bits. A snapshot of other tables is refused. */
CRANKLOOP_API crankloop_status crankloop_f_take(const crankloop_f_engine *engine, crankloop_f_snapshot *snapshot, size_t size);
CRANKLOOP_API crankloop_status crankloop_f_restore(crankloop_f_engine *engine, const crankloop_f_snapshot *snapshot, size_t size);

/* CRANKLOOP_F_SAVED_BYTES that any machine can read. Loading refuses all that is not exactly what was saved (docs/contract.md "Snapshots and
   versions") and changes nothing then. */
CRANKLOOP_API crankloop_status crankloop_f_save(const crankloop_f_engine *engine, unsigned char *bytes, size_t size);
CRANKLOOP_API crankloop_status crankloop_f_load(crankloop_f_engine *engine, const unsigned char *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif

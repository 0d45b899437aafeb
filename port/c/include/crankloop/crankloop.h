/* crankloop for C99: crank-resolved engine mechanics in real time.
 *
 *     definition  ->  tables  ->  engine: step, read
 *     (a struct)      (set-up)    (real time)
 *
 * This header has what all engines share: definitions, options, answers. Each engine has its own header, made from
 * the list of its inputs and outputs: crankloop_whole_f.h and crankloop_whole_d.h (crank speed given, all outputs,
 * float and double), crankloop_free_f.h and crankloop_free_d.h (crank turned by forces, with starter and trigger
 * wheels), each of 1 to 16 cylinders; and NAME.h of crankloop_add_scene(NAME ... WITH_C), smaller and faster.
 * docs/c_interface.md has examples; crankloop_engine_file.h reads engine files.
 *
 * Each call that takes a struct takes its size too, always `sizeof *pointer`, so that structs can grow at their end:
 * what an older program does not know of keeps its default, what it has no room for is not written. SI units; the unit
 * is in the name.
 */
#ifndef CRANKLOOP_CRANKLOOP_H
#define CRANKLOOP_CRANKLOOP_H

#include <stddef.h>
#include <stdint.h>

#include <crankloop/version.h>

#if defined(__GNUC__)
#define CRANKLOOP_API __attribute__((visibility("default")))
#define CRANKLOOP_ALIGNED(bytes) __attribute__((aligned(bytes))) /* no less than its type asks for */
#else
#define CRANKLOOP_API
#define CRANKLOOP_ALIGNED(bytes)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that was linked; compare with CRANKLOOP_VERSION, that of the header. */
CRANKLOOP_API uint32_t crankloop_version(void);

enum { CRANKLOOP_MAX_CYLINDERS = 16, CRANKLOOP_MAX_TRAINS = 4, CRANKLOOP_MAX_CAM_EXPONENTS = 8 };
enum { CRANKLOOP_MAX_TRIGGER_WHEELS = 8, CRANKLOOP_MAX_TOOTH_GAPS = 8, CRANKLOOP_MAX_LISTED_MISFIRES = 32 };
enum { CRANKLOOP_MAX_WHEEL_FAULTS = 16, CRANKLOOP_MAX_FLOW_POINTS = 16, CRANKLOOP_MAX_SENSOR_FAULTS = 16 };

/* ---- answers ----------------------------------------------------------------------------------------------------- */

/* Why a call was refused; crankloop_describe() has the words. */
enum {
  CRANKLOOP_OK = 0,
  CRANKLOOP_NOT_FINITE,
  CRANKLOOP_NOT_POSITIVE,
  CRANKLOOP_NEGATIVE,
  CRANKLOOP_OUT_OF_RANGE,
  CRANKLOOP_ROD_TOO_SHORT,
  CRANKLOOP_INCONSISTENT,
  CRANKLOOP_NOT_A_PERMUTATION,
  CRANKLOOP_TOO_FEW_POINTS,
  CRANKLOOP_TOO_MANY_POINTS,
  CRANKLOOP_NOT_INCREASING,
  CRANKLOOP_NOT_ONE_PERIOD,
  CRANKLOOP_NOT_A_CYCLE,
  CRANKLOOP_NO_SOLUTION,
  CRANKLOOP_PRESSURE_TOO_HIGH,
  CRANKLOOP_MISSING_TABLE,
  CRANKLOOP_OTHER_TABLES,
  CRANKLOOP_CONTRACTING_BUILD,
  CRANKLOOP_WRONG_SIZE,
  CRANKLOOP_DAMAGED,
  CRANKLOOP_OTHER_VERSION,
  CRANKLOOP_OTHER_SCENE,
  CRANKLOOP_NULL_POINTER,
  CRANKLOOP_MISALIGNED,
  CRANKLOOP_NOT_CREATED,
  CRANKLOOP_ALREADY_CREATED,
  CRANKLOOP_UNKNOWN_NAME,
  CRANKLOOP_TOO_MUCH_HEAT,
  CRANKLOOP_UNSTABLE
};

typedef struct crankloop_status {
  int32_t reason;    /* CRANKLOOP_OK, or why not */
  int32_t index;     /* cylinder or row counted from 0; -1 where the field is not a list */
  const char* field; /* what was refused, "crank.rod_length_m"; never null; lives for ever */
} crankloop_status;

/* A short English phrase for a reason, "must be greater than zero"; never null; lives for ever. */
CRANKLOOP_API const char* crankloop_describe(int32_t reason);

/* "layout.firing_deg[2] is out of range" into `text`, cut to `room` with its closing 0. Answers the length uncut, as
 * snprintf does. */
CRANKLOOP_API size_t crankloop_status_text(crankloop_status status, char* text, size_t room);

/* Bits of what a step answers: docs/contract.md "Inputs of a step". */
enum {
  CRANKLOOP_FAULT_NOT_READY = 1 << 0,
  CRANKLOOP_FAULT_SPEED = 1 << 1,
  CRANKLOOP_FAULT_LOAD_RATIO = 1 << 2,
  CRANKLOOP_FAULT_PRESSURE = 1 << 3,
  CRANKLOOP_FAULT_PHASE_JUMP = 1 << 4,
  CRANKLOOP_FAULT_CAM_PHASE = 1 << 5,
  CRANKLOOP_FAULT_EVENT_BUDGET = 1 << 6,
  CRANKLOOP_FAULT_EXTERNAL_TORQUE = 1 << 7,
  CRANKLOOP_FAULT_OVERSPEED = 1 << 8,
  CRANKLOOP_FAULT_TRIGGER_EDGES = 1 << 9,
  CRANKLOOP_FAULT_GAS = 1 << 10,
  CRANKLOOP_FAULT_MANIFOLD = 1 << 11,
  CRANKLOOP_FAULT_BURN = 1 << 12
};

/* ---- definition: what an engine is -------------------------------------------------------------------------------
 * Meaning and ranges of each field: crankloop/define/, where they have the same names. */

typedef struct crankloop_crank {
  double bore_m;
  double crank_radius_m; /* half the stroke */
  double rod_length_m;
  double pin_offset_m;
  double compression_ratio;
  double max_speed_rad_s; /* the highest speed the engine can have; 0 = the limit of the tick alone */
} crankloop_crank;

typedef struct crankloop_masses {
  double piston_kg;
  double rod_small_end_kg;
  double rod_big_end_kg;
  double rod_inertia_correction_kg_m2;
  double crank_pin_equivalent_kg;
  double crank_inertia_kg_m2;
} crankloop_masses;

typedef struct crankloop_layout {
  double firing_deg[CRANKLOOP_MAX_CYLINDERS]; /* or crankloop_set_firing_order() */
  double bank_deg[CRANKLOOP_MAX_CYLINDERS];
  double position_m[CRANKLOOP_MAX_CYLINDERS];
  uint8_t pin[CRANKLOOP_MAX_CYLINDERS]; /* which crank pin; default: each its own */
  int32_t cylinders;
} crankloop_layout;

enum {
  CRANKLOOP_PRESSURE_NONE,
  CRANKLOOP_PRESSURE_ANGLE_TABLE,
  CRANKLOOP_PRESSURE_VOLUME_TABLE,
  CRANKLOOP_PRESSURE_WIEBE,
  CRANKLOOP_PRESSURE_GAS /* refused where a ready-made engine has no gas exchange */
};

typedef struct crankloop_diagram_point {
  double at; /* crank angle in degrees, or volume in m^3 */
  double pressure_Pa;
} crankloop_diagram_point;

typedef struct crankloop_wiebe {
  double intake_Pa;
  double exhaust_Pa;
  double start_of_combustion_deg;
  double combustion_duration_deg;
  double wiebe_m;
  double compression_exponent;
  double expansion_exponent;
  double motored_expansion_exponent; /* 0: compression_exponent + 0.03 */
  double exhaust_valve_opens_deg;
  double net_mep_Pa; /* used unless heat_given */
  double heat_J;
  int32_t heat_given;
} crankloop_wiebe;

typedef struct crankloop_pressure {
  int32_t source; /* CRANKLOOP_PRESSURE_... */
  int32_t point_count;
  const crankloop_diagram_point* points; /* of a table; must live while tables are created, no longer */
  double crankcase_Pa;
  crankloop_wiebe wiebe;
} crankloop_pressure;

enum { CRANKLOOP_CAM_POLYNOMIAL, CRANKLOOP_CAM_TABLE };

typedef struct crankloop_cam_point {
  double cam_deg;
  double lift_m;
} crankloop_cam_point;

typedef struct crankloop_cam {
  int32_t source; /* CRANKLOOP_CAM_... */
  int32_t exponent_count;
  double max_lift_m;
  double half_angle_deg;
  double exponents[CRANKLOOP_MAX_CAM_EXPONENTS];
  const crankloop_cam_point* points; /* of a table; must live while tables are created, no longer */
  int32_t point_count;
  double smoothing_m;
  double full_lift_deg;
  double phase_rate_deg_s; /* 0 = fixed cam */
} crankloop_cam;

enum { CRANKLOOP_ROCKER_CIRCULAR_PAD, CRANKLOOP_ROCKER_RATIO };
enum { CRANKLOOP_CAM_TURNS_TOWARD_PIVOT, CRANKLOOP_CAM_TURNS_AWAY_FROM_PIVOT };

typedef struct crankloop_rocker {
  int32_t kind;      /* CRANKLOOP_ROCKER_... */
  int32_t cam_turns; /* CRANKLOOP_CAM_TURNS_... */
  double base_circle_m;
  double clearance_m;
  double ratio;
  double pivot_to_pad_m;
  double pivot_to_cam_m;
  double pad_radius_m;
  double pivot_to_screw_m;
  double screw_ball_m;
  double stem_above_pivot_m;
} crankloop_rocker;

typedef struct crankloop_valve {
  int32_t per_cylinder;
  double valve_kg;
  double spring_kg;
  double rocker_inertia_kg_m2;
  double spring_N_m;
  double spring_preload_N;
  double train_N_m;
  double train_damping_ratio;
  double guide_damping_ratio;
  double seat_N_m;
  double seat_damping_ratio;
  double head_area_m2;
  int32_t surge_modes;
  double surge_damping_ratio;
  double spring_active_kg;
  double inner_spring_N_m;
  double inner_spring_kg;
} crankloop_valve;

typedef struct crankloop_valve_train {
  crankloop_cam cam;
  crankloop_rocker rocker;
  crankloop_valve valve;
} crankloop_valve_train;

typedef struct crankloop_friction {
  double constant_Pa;
  double linear_Pa_s;
  double quadratic_Pa_s2;
} crankloop_friction;

typedef struct crankloop_machine {
  double constant_Nm;
  double linear_Nm_s;
  double quadratic_Nm_s2;
  double inertia_kg_m2;
} crankloop_machine;

typedef struct crankloop_starter {
  double stall_Nm;
  double no_load_rad_s;
} crankloop_starter;

enum { CRANKLOOP_TRIGGER_ON_CRANK, CRANKLOOP_TRIGGER_ON_CAM };
enum { CRANKLOOP_TRIGGER_TEETH, CRANKLOOP_TRIGGER_EDGES };

typedef struct crankloop_tooth_gap {
  int32_t teeth; /* before it */
  int32_t missing;
} crankloop_tooth_gap;

typedef struct crankloop_trigger_wheel {
  int32_t shaft; /* CRANKLOOP_TRIGGER_ON_... */
  int32_t train; /* whose phaser moves it too; -1: none does */
  int32_t pattern;
  int32_t places; /* teeth and missing ones in a turn of the shaft */
  int32_t gap_count;
  int32_t edge_count;
  crankloop_tooth_gap gaps[CRANKLOOP_MAX_TOOTH_GAPS];
  double first_tooth_deg;
  double tooth_ratio;
  const double* edges_deg; /* must live while tables are created, no longer */
  int32_t inverted;
} crankloop_trigger_wheel;

enum {
  CRANKLOOP_MISFIRE_NONE,
  CRANKLOOP_MISFIRE_SPREAD, /* `misfires` of every `of` cycles, evenly spread */
  CRANKLOOP_MISFIRE_BURST,  /* the last `misfires` of every `of` cycles */
  CRANKLOOP_MISFIRE_RANDOM, /* each cycle with the probability random_ratio */
  CRANKLOOP_MISFIRE_LISTED
};

typedef struct crankloop_misfire {
  double random_ratio;
  double burning_ratio; /* share of its heat that a misfiring cycle releases */
  int32_t pattern;      /* CRANKLOOP_MISFIRE_... */
  int32_t misfires;
  int32_t of;
  int32_t seed;
  int32_t cycle_count;
  int32_t cycles[CRANKLOOP_MAX_LISTED_MISFIRES]; /* from 1, rising */
} crankloop_misfire;

enum { CRANKLOOP_STUCK_NO, CRANKLOOP_STUCK_LOW, CRANKLOOP_STUCK_HIGH };

/* What is wrong with a trigger wheel, its sensor or its wire, and when; angles in crank degrees. */
typedef struct crankloop_wheel_fault {
  double start_s; /* on from here to before end_s, and while input_bit of the input wheel_faults is set */
  double end_s;
  double moved_deg;
  double extra_tooth_deg;
  double extra_width_deg; /* 0: no extra tooth */
  double runout_deg;
  double runout_at_deg;
  double late_deg;
  double noise_Hz;
  double noise_pulse_s;
  int32_t wheel;         /* counted from 0 */
  int32_t input_bit;     /* -1: none */
  int32_t missing_tooth; /* from 1; 0: none */
  int32_t moved_tooth;
  int32_t inverted;
  int32_t stuck; /* CRANKLOOP_STUCK_... */
  int32_t noise_seed;
} crankloop_wheel_fault;

/* Where cam and follower of a train touch. No ready-made engine works out their stress or friction. */
typedef struct crankloop_cam_contact {
  double width_m; /* 0: not known */
  double friction_ratio;
  double cam_Pa;
  double cam_poisson_ratio;
  double follower_Pa;
  double follower_poisson_ratio;
} crankloop_cam_contact;

enum { CRANKLOOP_PORT_NONE, CRANKLOOP_PORT_INTAKE, CRANKLOOP_PORT_EXHAUST };

typedef struct crankloop_port {
  double seat_diameter_m;
  double flow_lift_ratio[CRANKLOOP_MAX_FLOW_POINTS];
  double flow_ratio[CRANKLOOP_MAX_FLOW_POINTS];
  int32_t port; /* CRANKLOOP_PORT_... */
  int32_t flow_count;
} crankloop_port;

typedef struct crankloop_runner {
  double length_m; /* 0: none */
  double diameter_m;
  double loss_ratio;
} crankloop_runner;

typedef struct crankloop_crevice {
  double volume_ratio; /* 0: none */
  double blow_by_m2;   /* 0: tight */
} crankloop_crevice;

typedef struct crankloop_walls {
  double capacity_J_K; /* 0: fixed at wall_K */
  double to_coolant_W_K;
  double coolant_K;
  double intake_W_K;
  double exhaust_W_K;
  double manifold_K; /* 0: ambient_K */
} crankloop_walls;

typedef struct crankloop_charge_burn {
  double spark_to_start_deg;
  double reference_rad_s;
  double reference_K;
  double reference_Pa;
  double reference_burned_ratio;
  double reference_excess_air_ratio;
  int32_t in_use;
} crankloop_charge_burn;

/* Gas exchange through the valves; pressures are absolute. */
typedef struct crankloop_gas {
  double intake_m3;
  double exhaust_m3;
  double throttle_m2;
  double throttle_closed_m2;
  double throttle_ratio[CRANKLOOP_MAX_FLOW_POINTS];
  double throttle_area_ratio[CRANKLOOP_MAX_FLOW_POINTS];
  double outlet_m2;
  double ambient_Pa;
  double back_Pa; /* 0: ambient_Pa */
  double ambient_K;
  double exhaust_K;
  double wall_K;
  double wall_heat_ratio;
  double fuel_kg;
  double excess_air_ratio; /* 0: fuel_kg */
  double heating_value_J_kg;
  double combustion_efficiency;
  double air_fuel_ratio;
  double latch_deg;
  double burn_start_deg;
  double burn_duration_deg;
  double wiebe_m;
  double second_ratio;
  double second_m;
  double second_duration_ratio;
  double octane_number; /* 0: none */
  crankloop_crevice crevice;
  crankloop_runner intake_runner;
  crankloop_runner exhaust_runner;
  crankloop_walls walls;
  crankloop_charge_burn charge_burn;
  crankloop_port ports[CRANKLOOP_MAX_TRAINS];
  int32_t throttle_count;
} crankloop_gas;

/* A variable reluctance sensor at a trigger wheel, and its comparator. No ready-made engine samples it. */
typedef struct crankloop_reluctor {
  double gain_V_s; /* peak voltage at a tooth by the wheel's speed in rad/s */
  double reach_ratio;
  double gap_lobe_ratio;
  double runout_ratio;
  double runout_at_deg; /* of the wheel's turn, from the first rising edge */
  double arm_ratio;     /* comparator */
  double least_V;
  double hysteresis_V;
  double watchdog_s;
  double delay_s;   /* of the comparator's edges */
  int32_t wheel;    /* counted from 0; -1: no sensor */
  int32_t reversed; /* its wires */
} crankloop_reluctor;

/* A lambda sensor in the exhaust pipe, of an engine with gas exchange. */
typedef struct crankloop_lambda_sensor {
  double pipe_m3; /* volume of the pipe from the exhaust manifold to it */
  double lag_s;   /* its time constant; 0: none */
  int32_t in_use;
} crankloop_lambda_sensor;

enum {
  CRANKLOOP_SENSOR_MAP,        /* Pa */
  CRANKLOOP_SENSOR_INTAKE_AIR, /* K */
  CRANKLOOP_SENSOR_TPS,
  CRANKLOOP_SENSOR_LAMBDA,
  CRANKLOOP_SENSOR_COOLANT /* K */
};
enum { CRANKLOOP_WIRE_GOOD, CRANKLOOP_WIRE_STUCK, CRANKLOOP_WIRE_OPEN, CRANKLOOP_WIRE_SHORTED };

/* What is wrong with a controller's sensor, and when; in the unit of its value. */
typedef struct crankloop_sensor_fault {
  double start_s; /* on from here to before end_s, and while input_bit of the input sensor_faults is set */
  double end_s;
  double offset;
  double noise; /* evenly from -noise to noise, in each tick */
  double delay_s;
  double lag_s;
  double least; /* range; none where most is not above least */
  double most;
  double step;       /* of a converter; 0: none */
  int32_t sensor;    /* CRANKLOOP_SENSOR_... */
  int32_t input_bit; /* -1: none */
  int32_t wire;      /* CRANKLOOP_WIRE_... */
  int32_t noise_seed;
} crankloop_sensor_fault;

/* The structs above keep their size; what comes later stands at the end of this one. */
typedef struct crankloop_definition {
  crankloop_crank crank;
  crankloop_masses masses;
  crankloop_layout layout;
  crankloop_pressure pressure;
  int32_t train_count;
  crankloop_valve_train trains[CRANKLOOP_MAX_TRAINS];
  crankloop_friction friction; /* this and what follows: for cranks that forces turn */
  crankloop_machine machine;
  crankloop_starter starter;
  int32_t trigger_count;
  crankloop_trigger_wheel triggers[CRANKLOOP_MAX_TRIGGER_WHEELS];
  crankloop_misfire misfires[CRANKLOOP_MAX_CYLINDERS];
  int32_t wheel_fault_count;
  crankloop_wheel_fault wheel_faults[CRANKLOOP_MAX_WHEEL_FAULTS];
  crankloop_cam_contact contacts[CRANKLOOP_MAX_TRAINS]; /* of each train's cam */
  crankloop_gas gas;                                    /* read where pressure.source is CRANKLOOP_PRESSURE_GAS */
  crankloop_reluctor reluctor;
  crankloop_lambda_sensor lambda_sensor;
  int32_t sensor_fault_count;
  crankloop_sensor_fault sensor_faults[CRANKLOOP_MAX_SENSOR_FAULTS];
} crankloop_definition;

/* Fills in every default. Begin with this: a zeroed definition has other values. */
CRANKLOOP_API crankloop_status crankloop_definition_defaults(crankloop_definition* definition, size_t size);

/* Even firing over 720 deg in this order (cylinder numbers from 1); sets the number of cylinders. */
CRANKLOOP_API crankloop_status crankloop_set_firing_order(crankloop_definition* definition, size_t size,
                                                          const int32_t* order, int32_t cylinders);

/* Cylinders at one position whose throws point the same way share a pin. */
CRANKLOOP_API crankloop_status crankloop_share_pins_by_position(crankloop_definition* definition, size_t size);

/* ---- options: how the engine will be stepped --------------------------------------------------------------------- */

enum { CRANKLOOP_INTEGRATOR_RK4, CRANKLOOP_INTEGRATOR_EXPONENTIAL };

typedef struct crankloop_options {
  double tick_s;
  double valve_accuracy_m;
  int32_t valve_integrator;   /* CRANKLOOP_INTEGRATOR_... */
  int32_t valve_event_budget; /* units of work for events in a tick; 0 = by the engine */
  double max_speed_rad_s;     /* beyond it a speed is refused as an input; 0 = that of the definition */
} crankloop_options;

CRANKLOOP_API crankloop_status crankloop_options_defaults(crankloop_options* options, size_t size);

/* ---- columns of NAME_step_many() --------------------------------------------------------------------------------- */

/* One variable over all ticks: an input, which is read, or an output, which is written; its name says which. Numbers
 * whatever it is kept as: a phase in degrees, yes as 1. */
typedef struct crankloop_column {
  const char* name; /* "speed_rad_s", "valve[2,1].lift_m": as the structs have it, indices from 1; "faults" */
  double* values;
  size_t count;  /* room in values */
  size_t stride; /* from tick to tick: 1 = one value after another, 0 = the same for all ticks */
  /* The library's, while it works: */
  void* at;
  int32_t storage;
  int32_t is_input;
} crankloop_column;

#ifdef __cplusplus
}
#endif

#endif

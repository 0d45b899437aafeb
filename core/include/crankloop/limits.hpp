// The few bounds that every room knows.
#pragma once

namespace crankloop {

inline constexpr int kMaxCylinders = 16;
inline constexpr int kMaxTrains = 4;       ///< valve trains of a cylinder: intake, exhaust, and two more
inline constexpr int kMaxSpringModes = 3;  ///< of one valve spring's surge
inline constexpr int kMaxValveModes = 2 * kMaxSpringModes;  ///< of a valve with two nested springs
inline constexpr int kMaxTriggerWheels = 8;
inline constexpr int kMaxTriggerEdges = 720;     ///< of one wheel in a turn of it
inline constexpr int kMaxListedMisfires = 32;    ///< cycles of one cylinder that a list names
inline constexpr int kMaxMisfirePeriod = 65535;  ///< cycles after which a pattern repeats
inline constexpr int kControllerSensors = 5;
inline constexpr int kMaxSensorFaults = 16;
inline constexpr int kMaxWheelFaults = 16;
inline constexpr double kMaxSpeed_rad_s = 10472;  ///< 100 000 rpm, whatever the engine
inline constexpr double kMaxPressure_Pa =
    1e8;  ///< 1000 bar in a cylinder, whether a tick is given it, a table holds it or heat makes it

}  // namespace crankloop

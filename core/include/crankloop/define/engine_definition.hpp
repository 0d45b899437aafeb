// A whole engine, as its designer knows it.
#pragma once

#include <crankloop/define/cam_contact.hpp>
#include <crankloop/define/crank.hpp>
#include <crankloop/define/crank_dynamics.hpp>
#include <crankloop/define/field.hpp>
#include <crankloop/define/gas.hpp>
#include <crankloop/define/lambda_sensor.hpp>
#include <crankloop/define/layout.hpp>
#include <crankloop/define/masses.hpp>
#include <crankloop/define/misfire.hpp>
#include <crankloop/define/pressure.hpp>
#include <crankloop/define/reluctor.hpp>
#include <crankloop/define/sensor_fault.hpp>
#include <crankloop/define/trigger_wheel.hpp>
#include <crankloop/define/valve_train.hpp>
#include <crankloop/define/wheel_fault.hpp>

namespace crankloop {

struct EngineDefinition {
  Crank crank;
  Masses masses;
  Layout layout;
  Pressure pressure;
  int train_count = 0;  ///< 0 to kMaxTrains
  ValveTrain trains[kMaxTrains];
  Friction friction;
  DrivenMachine machine;
  Starter starter;
  int trigger_count = 0;  ///< 0 to kMaxTriggerWheels
  TriggerWheel triggers[kMaxTriggerWheels];
  Gas gas;                                      ///< read where pressure.source is gas
  CamContact contacts[kMaxTrains];              ///< of each train's cam
  Misfire misfires[kMaxCylinders];              ///< of each cylinder; a scene with misfire takes them
  int wheel_fault_count = 0;                    ///< 0 to kMaxWheelFaults
  WheelFault wheel_faults[kMaxWheelFaults];     ///< a scene with wheel_faults takes them
  Reluctor reluctor;                            ///< a scene with reluctor_samples takes it
  LambdaSensor lambda_sensor;                   ///< a scene with lambda_parcels takes it
  int sensor_fault_count = 0;                   ///< 0 to kMaxSensorFaults
  SensorFault sensor_faults[kMaxSensorFaults];  ///< a scene with sensor_faults takes them

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_PART(1, crank);
    CRANKLOOP_PART(1, masses);
    CRANKLOOP_PART(1, layout);
    CRANKLOOP_PART(1, pressure);
    CRANKLOOP_PART(1, train_count);
    CRANKLOOP_PART(self.train_count, trains);
    CRANKLOOP_PART(1, friction);
    CRANKLOOP_PART(1, machine);
    CRANKLOOP_PART(1, starter);
  }
};

/// Validates every part and what the parts demand of one another; the first refusal is returned. A part is validated
/// whether a scene needs it or not: tables carry the fingerprint of the whole definition. Not read, and not validated:
/// trains and wheels beyond their counts, rows that no source uses, gas where the pressure has another source, fuel_kg
/// where excess_air_ratio sets the fuel. About a valve train or a trigger wheel, `index` is its number. Whether the
/// rocker's geometry closes is found where the lift is worked out (tabulate).
Status validate(const EngineDefinition& engine) noexcept;

}  // namespace crankloop

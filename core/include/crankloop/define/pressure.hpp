// Where the cylinder pressure comes from when it is not an input of every tick.
//
// What belongs here: diagrams as given. What does not: pressure over crank angle as used
// (tabulate/indicator_diagram.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/crank.hpp>
#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class PressureSource : std::uint8_t {
  none,          ///< p = p0 at all times: no gas force
  angle_table,   ///< rows (crank_deg, pressure_Pa), one 720 deg period
  volume_table,  ///< rows (volume_m3, pressure_Pa), the loop in the order of time from firing top dead centre
  wiebe,         ///< synthesised: docs/model.md "Synthesised diagram"
  gas,           ///< no diagram: it follows from what is in the cylinder (EngineDefinition::gas), in scenes with
                 ///< PressureGiven::by_gas
};

/// How far from 0 an angle table may lie: there a double resolves 1e-10 deg, beyond 1e9 deg not even
/// 1e-7.
inline constexpr double kMaxDiagramAngle_deg = 1e6;

/// One row of a diagram: crank angle in degrees, within +-kMaxDiagramAngle_deg, or volume in m^3, and absolute
/// pressure, 0 to kMaxPressure_Pa.
struct DiagramPoint {
  double at;
  double pressure_Pa;
};

/// A cylinder that does not fire loses heat and gas: its expansion lies below its compression by (volume / clearance
/// volume) to the minus this.
inline constexpr double kMotoredLoss = 0.03;

/// Synthesised four-stroke diagram. Angles in degrees of the cylinder's own crank angle, firing at 0.
struct WiebeDiagram {
  double intake_Pa = 98e3;    ///< plenum, from gas-exchange top dead centre to bottom dead centre
  double exhaust_Pa = 105e3;  ///< back pressure
  double start_of_combustion_deg = -6;
  double combustion_duration_deg = 60;    ///< must end before the exhaust valve opens
  double wiebe_m = 0.9;                   ///< form exponent
  double compression_exponent = 1.35;     ///< n1
  double expansion_exponent = 1.28;       ///< n2
  double motored_expansion_exponent = 0;  ///< of a cylinder that does not fire: at least n1; 0 = n1 + kMotoredLoss
  double exhaust_valve_opens_deg = 135;
  bool heat_given = false;  ///< true: heat_J is used; false: heat is scaled to net_mep_Pa
  double net_mep_Pa = 0;    ///< indicated mean effective pressure over 720 deg at load ratio 1; from the motored one on
  double heat_J = 0;        ///< heat released per cycle and cylinder at load ratio 1; 0 = motored

  [[nodiscard]] constexpr double motored_exponent() const noexcept {
    return motored_expansion_exponent > 0 ? motored_expansion_exponent : compression_exponent + kMotoredLoss;
  }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, pressure.wiebe, intake_Pa, above(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, pressure.wiebe, exhaust_Pa, above(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, pressure.wiebe, start_of_combustion_deg, from(-90).up_to(90));
    CRANKLOOP_NUMBER(1, pressure.wiebe, combustion_duration_deg, from(1).up_to(150));
    CRANKLOOP_NUMBER(1, pressure.wiebe, wiebe_m, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, pressure.wiebe, compression_exponent, from(1).up_to(2));
    CRANKLOOP_NUMBER(1, pressure.wiebe, expansion_exponent, from(1.0001).up_to(2));
    CRANKLOOP_NUMBER(1, pressure.wiebe, motored_expansion_exponent, from(0).up_to(3));
    CRANKLOOP_NUMBER(1, pressure.wiebe, exhaust_valve_opens_deg, from(30).up_to(179));
    CRANKLOOP_NUMBER(self.heat_given ? 0 : 1, pressure.wiebe, net_mep_Pa, from(-1e7).up_to(kMaxPressure_Pa));
    CRANKLOOP_NUMBER(self.heat_given ? 1 : 0, pressure.wiebe, heat_J, from(0).up_to(1e9));
    CRANKLOOP_FIELD(1, pressure.wiebe, heat_given);
  }
};

/// Pressure at load ratio q, at most kMaxPressure_Pa at q = 1, is p_motored(a) + q (p_full(a) - p_motored(a)).
///
/// The motored diagram is that of a cylinder without combustion, and does no work: docs/model.md "Load ratio".
struct Pressure {
  PressureSource source = PressureSource::none;
  double crankcase_Pa = 100e3;  ///< p0, on the piston's other side
  WiebeDiagram wiebe{};
  const DiagramPoint* points =
      nullptr;  ///< rows of a table source, which alone reads them; the caller keeps them alive while tabulating
  int point_count = 0;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool synthesised = self.source == PressureSource::wiebe;
    CRANKLOOP_FIELD(1, pressure, source);
    CRANKLOOP_NUMBER(1, pressure, crankcase_Pa, above(0).up_to(1e7));
    CRANKLOOP_PART(synthesised ? 1 : 0, wiebe);
    CRANKLOOP_FIELD(synthesised ? 0 : 1, pressure, point_count);
    CRANKLOOP_FIELD(synthesised ? 0 : self.point_count, pressure, points);
  }
};

/// Field names "pressure.*". Row errors carry the row in `index`.
Status validate(const Pressure& pressure, const Crank& crank) noexcept;

}  // namespace crankloop

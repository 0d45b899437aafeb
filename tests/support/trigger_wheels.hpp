// Trigger wheels for tests: each drawn place by place, beside the definition that should mean the same.
//
// What belongs here: wheels and where their edges are by drawing. What does not: expectations.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "support/engines.hpp"

namespace crankloop::tick_test {

/// One place after another over the turn of its shaft: x a tooth, - none.
struct DrawnWheel {
  std::string name;
  std::string places;
  TriggerWheel definition;

  [[nodiscard]] double turn_deg() const { return definition.shaft == TriggerShaft::crank ? 360 : 720; }

  /// Crank degrees from the first rising edge, over one turn of the wheel: rise, fall, rise, ...
  [[nodiscard]] std::vector<long double> edges_deg() const {
    std::vector<long double> edges;
    const long double place_deg = static_cast<long double>(turn_deg()) / static_cast<long double>(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] != 'x') continue;
      edges.push_back(static_cast<long double>(i) * place_deg);
      edges.push_back((static_cast<long double>(i) + static_cast<long double>(definition.tooth_ratio)) * place_deg);
    }
    return edges;
  }
};

inline TriggerWheel toothed(TriggerShaft shaft, int places, std::initializer_list<ToothGap> gaps,
                            double first_tooth_deg, double tooth_ratio = 0.5) {
  TriggerWheel wheel;
  wheel.shaft = shaft;
  wheel.places = places;
  for (const ToothGap& gap : gaps) wheel.gaps[wheel.gap_count++] = gap;
  wheel.first_tooth_deg = first_tooth_deg;
  wheel.tooth_ratio = tooth_ratio;
  return wheel;
}

/// As many as an engine may have, of every kind.
inline std::vector<DrawnWheel> drawn_wheels() {
  constexpr auto crank = TriggerShaft::crank;
  constexpr auto cam = TriggerShaft::cam;
  const auto teeth = [](std::size_t n) { return std::string(n, 'x'); };
  std::vector<DrawnWheel> wheels{
      {"60-2", teeth(58) + "--", toothed(crank, 60, {{58, 2}}, 246)},
      {"36-1", teeth(35) + "-", toothed(crank, 36, {{35, 1}}, 84.5, 0.3)},
      {"36-2-2-2", teeth(13) + "--" + teeth(16) + "--x--", toothed(crank, 36, {{13, 2}, {16, 2}, {1, 2}}, 0)},
      {"360", teeth(360), toothed(crank, 360, {}, 719.75)},
      {"1", "x", toothed(crank, 1, {}, 300, 0.01)},
      {"half-moon", "x", toothed(cam, 1, {}, 30)},
      {"4-1 cam", "xxx-", toothed(cam, 4, {{3, 1}}, 500, 0.25)},
      {"gaps inside", "xx-xxx--xxxx", toothed(cam, 12, {{2, 1}, {3, 2}}, 359.999, 0.99)},
  };
  wheels[1].definition.inverted = true;
  return wheels;
}

/// The 495 with all of them.
inline EngineDefinition with_wheels(EngineDefinition engine, const std::vector<DrawnWheel>& wheels) {
  for (const DrawnWheel& wheel : wheels) engine.triggers[engine.trigger_count++] = wheel.definition;
  return engine;
}

}  // namespace crankloop::tick_test

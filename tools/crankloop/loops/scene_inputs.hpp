// The inputs of a ready-made scene as numbers, in the order of the list of variables: for inputs that come by name.
//
// What belongs here: names, ranges, and copying to and from a step's input. What does not: where the numbers come from
// (input_schedule.hpp, commands/live).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <crankloop/define/range.hpp>
#include <crankloop/fmi/name.hpp>
#include <crankloop/scenes.hpp>
#include <crankloop/variable_values.hpp>
#include <crankloop/variables.hpp>

namespace crankloop::program {

/// Of a scene with any engine.
inline constexpr std::size_t kMaxSceneInputs = 128;

/// How many a scene's largest engine has.
template <class S>
[[nodiscard]] constexpr std::size_t input_count() noexcept {
  std::size_t count = 0;
  Input<double, S> any{};
  const auto add = [&count](const detail::Variable&, auto&) { ++count; };
  detail::each_input<S>(add, any, detail::EngineShape{S::cylinders.capacity, S::trains.capacity, 0, 0});
  return count;
}

struct SceneInput {
  std::string name;  ///< "fuel_kg[2]", in SI units
  detail::VariableKind kind;
  Range range;
};

/// `shape`: of the engine's tables. "cut_cylinders" has a bit for each cylinder.
template <class S>
[[nodiscard]] std::vector<SceneInput> scene_inputs(const detail::EngineShape& shape) {
  std::vector<SceneInput> inputs;
  Input<double, S> any;
  const auto add = [&](const detail::Variable& variable, auto&) {
    Range range;
    if (variable.least < variable.most) range = from(variable.least).up_to(variable.most);
    if (variable.kind == detail::VariableKind::truth) range = from(0).up_to(1);
    if (variable.kind == detail::VariableKind::whole) {
      const bool of_cylinders = std::string_view(variable.name) == "cut_cylinders";
      range = from(0).up_to(static_cast<double>((std::uint64_t{1} << (of_cylinders ? shape.cylinders : 32)) - 1));
    }
    inputs.push_back({fmi::name_of(variable), variable.kind, range});
  };
  detail::each_input<S>(add, any, shape);
  return inputs;
}

/// As many numbers as scene_inputs() has. What the scene's arithmetic does not hold is not finite, which the tick
/// reports; what a whole number does not hold is 0.
template <class Real, class S>
void set_inputs(Input<Real, S>& input, const detail::EngineShape& shape, const double* numbers) noexcept {
  static_assert(input_count<S>() <= kMaxSceneInputs);
  const auto set = [&numbers](const detail::Variable&, auto& value) { detail::assign(value, *numbers++); };
  detail::each_input<S>(set, input, shape);
}

template <class Real, class S>
void get_inputs(const Input<Real, S>& input, const detail::EngineShape& shape, double* numbers) noexcept {
  const auto get = [&numbers](const detail::Variable&, const auto& value) { *numbers++ = detail::as_number(value); };
  detail::each_input<S>(get, input, shape);
}

}  // namespace crankloop::program

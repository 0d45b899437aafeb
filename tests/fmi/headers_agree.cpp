// Whether our declarations of FMI are those of the standard's headers, for developers who have them: configure with
// -DCRANKLOOP_FMI_HEADERS=FOLDER, the six headers in it. It compiles, or names the function that differs.
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "functions.h"

namespace ours {
#include <crankloop/fmi/fmi2_abi.h>
#include <crankloop/fmi/fmi3_abi.h>
}  // namespace ours

namespace {

template <std::size_t kSize, std::size_t kAlignment>
struct Struct {};

/// What the binary interface sees of a type: two enumerations are alike, as are two structs of one size.
template <class T, class = void>
struct ShapeOf {
  using Type = T;
};
template <class T>
using Shape = typename ShapeOf<T>::Type;
template <class T>
struct ShapeOf<T, std::enable_if_t<std::is_enum_v<T> && !std::is_const_v<T>>> {
  using Type = std::underlying_type_t<T>;
};
template <class T>
struct ShapeOf<T, std::enable_if_t<std::is_class_v<T> && !std::is_const_v<T>>> {
  using Type = Struct<sizeof(T), alignof(T)>;
};
template <class T>
struct ShapeOf<const T, void> {
  using Type = const Shape<T>;
};
template <class T>
struct ShapeOf<T*, void> {
  using Type = Shape<T>*;
};
template <class Result, class... Each>
struct ShapeOf<Result(Each...), void> {
  using Type = Shape<Result>(Shape<Each>...);
};

// Before the standard's headers are read, since those make macros of the functions' names.
#define INDEX_2(name) k2##name,
#define INDEX_3(name) k3##name,
enum Index2 { FMI2_FUNCTIONS(INDEX_2) kCount2 };
enum Index3 { FMI3_FUNCTIONS(INDEX_3) kCount3 };
#define OURS_2(name) Shape<decltype(&ours::fmi2##name)>,
#define OURS_3(name) Shape<decltype(&ours::fmi3##name)>,
using Ours2 = std::tuple<FMI2_FUNCTIONS(OURS_2) void*>;
using Ours3 = std::tuple<FMI3_FUNCTIONS(OURS_3) void*>;

}  // namespace

// With a prefix, so that two declarations of one C function do not meet.
#define FMI2_FUNCTION_PREFIX official_
#define FMI3_FUNCTION_PREFIX official_
namespace official {
#include <fmi2Functions.h>
#include <fmi3Functions.h>
}  // namespace official

#define AGREE_2(name)                                                                                          \
  static_assert(std::is_same_v<std::tuple_element_t<k2##name, Ours2>, Shape<decltype(&official::fmi2##name)>>, \
                "fmi2" #name);
#define AGREE_3(name)                                                                                          \
  static_assert(std::is_same_v<std::tuple_element_t<k3##name, Ours3>, Shape<decltype(&official::fmi3##name)>>, \
                "fmi3" #name);
FMI2_FUNCTIONS(AGREE_2)
FMI3_FUNCTIONS(AGREE_3)

#define SAME(name) static_assert(static_cast<int>(ours::name) == static_cast<int>(official::name), #name);
SAME(fmi2OK)
SAME(fmi2Discard)
SAME(fmi2Error)
SAME(fmi2CoSimulation)
SAME(fmi2LastSuccessfulTime)
SAME(fmi2Terminated)
SAME(fmi3OK)
SAME(fmi3Error)
SAME(fmi3Dependent)
SAME(fmi3IntervalChanged)
static_assert(sizeof(ours::fmi2CallbackFunctions) == sizeof(official::fmi2CallbackFunctions));
static_assert(sizeof(ours::fmi2EventInfo) == sizeof(official::fmi2EventInfo));

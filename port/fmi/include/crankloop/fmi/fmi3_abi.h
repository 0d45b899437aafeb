/* FMI 3.0 for co-simulation, as far as a binary interface needs it: types, constants, and every function that the
 * standard's headers name, for C99 and C++. In our own words, from the specification's tables; no text of the official
 * headers.
 *
 * Where the official headers are at hand, tests compare prototype by prototype (tests/fmi).
 */
#ifndef CRANKLOOP_FMI3_ABI_H
#define CRANKLOOP_FMI3_ABI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define CRANKLOOP_FMI3_API __declspec(dllexport)
#else
#define CRANKLOOP_FMI3_API __attribute__((visibility("default")))
#endif

/* Where a source build must put its identifier before every function's name, it defines FMI3_FUNCTION_PREFIX as that.
 */
#if defined(FMI3_FUNCTION_PREFIX)
#define CRANKLOOP_FMI3_JOIN(prefix, name) prefix##name
#define CRANKLOOP_FMI3_NAME_2(prefix, name) CRANKLOOP_FMI3_JOIN(prefix, name)
#define CRANKLOOP_FMI3_NAME(name) CRANKLOOP_FMI3_NAME_2(FMI3_FUNCTION_PREFIX, name)
#else
#define CRANKLOOP_FMI3_NAME(name) name
#endif

typedef void* fmi3Instance;
typedef void* fmi3InstanceEnvironment;
typedef void* fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char* fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte* fmi3Binary;
typedef bool fmi3Clock;

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum { fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String category, fmi3String message);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64 time_s, fmi3Boolean set_requested,
                                               fmi3Boolean get_allowed, fmi3Boolean step_finished,
                                               fmi3Boolean can_return_early, fmi3Boolean* return_requested,
                                               fmi3Float64* return_time_s);

/* What is passed by value reference: which, how many. */
#define CRANKLOOP_FMI3_WHICH fmi3Instance, const fmi3ValueReference[], size_t
#define CRANKLOOP_FMI3(name, arguments) CRANKLOOP_FMI3_API fmi3Status CRANKLOOP_FMI3_NAME(name) arguments;
#define CRANKLOOP_FMI3_TYPE(name)                                                             \
  CRANKLOOP_FMI3(fmi3Get##name, (CRANKLOOP_FMI3_WHICH, fmi3##name values[], size_t n_values)) \
  CRANKLOOP_FMI3(fmi3Set##name, (CRANKLOOP_FMI3_WHICH, const fmi3##name values[], size_t n_values))

CRANKLOOP_FMI3_API const char* CRANKLOOP_FMI3_NAME(fmi3GetVersion)(void);
CRANKLOOP_FMI3_API fmi3Instance CRANKLOOP_FMI3_NAME(fmi3InstantiateModelExchange)(
    fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible, fmi3Boolean logging_on,
    fmi3InstanceEnvironment, fmi3LogMessageCallback);
CRANKLOOP_FMI3_API fmi3Instance CRANKLOOP_FMI3_NAME(fmi3InstantiateCoSimulation)(
    fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible, fmi3Boolean logging_on,
    fmi3Boolean event_mode_used, fmi3Boolean early_return_allowed, const fmi3ValueReference intermediate[],
    size_t n_intermediate, fmi3InstanceEnvironment, fmi3LogMessageCallback, fmi3IntermediateUpdateCallback);
CRANKLOOP_FMI3_API fmi3Instance CRANKLOOP_FMI3_NAME(fmi3InstantiateScheduledExecution)(
    fmi3String name, fmi3String token, fmi3String resource_path, fmi3Boolean visible, fmi3Boolean logging_on,
    fmi3InstanceEnvironment, fmi3LogMessageCallback, fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
    fmi3UnlockPreemptionCallback);
CRANKLOOP_FMI3_API void CRANKLOOP_FMI3_NAME(fmi3FreeInstance)(fmi3Instance);
CRANKLOOP_FMI3(fmi3SetDebugLogging, (fmi3Instance, fmi3Boolean on, size_t count, const fmi3String categories[]))
CRANKLOOP_FMI3(fmi3EnterInitializationMode, (fmi3Instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                             fmi3Float64 start_s, fmi3Boolean has_stop, fmi3Float64 stop_s))
CRANKLOOP_FMI3(fmi3ExitInitializationMode, (fmi3Instance))
CRANKLOOP_FMI3(fmi3Terminate, (fmi3Instance))
CRANKLOOP_FMI3(fmi3Reset, (fmi3Instance))

CRANKLOOP_FMI3_TYPE(Float32)
CRANKLOOP_FMI3_TYPE(Float64)
CRANKLOOP_FMI3_TYPE(Int8)
CRANKLOOP_FMI3_TYPE(UInt8)
CRANKLOOP_FMI3_TYPE(Int16)
CRANKLOOP_FMI3_TYPE(UInt16)
CRANKLOOP_FMI3_TYPE(Int32)
CRANKLOOP_FMI3_TYPE(UInt32)
CRANKLOOP_FMI3_TYPE(Int64)
CRANKLOOP_FMI3_TYPE(UInt64)
CRANKLOOP_FMI3_TYPE(Boolean)
CRANKLOOP_FMI3_TYPE(String)
CRANKLOOP_FMI3(fmi3GetBinary, (CRANKLOOP_FMI3_WHICH, size_t sizes[], fmi3Binary values[], size_t n_values))
CRANKLOOP_FMI3(fmi3SetBinary, (CRANKLOOP_FMI3_WHICH, const size_t sizes[], const fmi3Binary values[], size_t n_values))
CRANKLOOP_FMI3(fmi3GetClock, (CRANKLOOP_FMI3_WHICH, fmi3Clock values[]))
CRANKLOOP_FMI3(fmi3SetClock, (CRANKLOOP_FMI3_WHICH, const fmi3Clock values[]))

CRANKLOOP_FMI3(fmi3GetFMUState, (fmi3Instance, fmi3FMUState*))
CRANKLOOP_FMI3(fmi3SetFMUState, (fmi3Instance, fmi3FMUState))
CRANKLOOP_FMI3(fmi3FreeFMUState, (fmi3Instance, fmi3FMUState*))
CRANKLOOP_FMI3(fmi3SerializedFMUStateSize, (fmi3Instance, fmi3FMUState, size_t*))
CRANKLOOP_FMI3(fmi3SerializeFMUState, (fmi3Instance, fmi3FMUState, fmi3Byte[], size_t))
CRANKLOOP_FMI3(fmi3DeserializeFMUState, (fmi3Instance, const fmi3Byte[], size_t, fmi3FMUState*))

CRANKLOOP_FMI3(fmi3DoStep, (fmi3Instance, fmi3Float64 time_s, fmi3Float64 step_s, fmi3Boolean no_set_state_before,
                            fmi3Boolean* event_handling_needed, fmi3Boolean* terminate_simulation,
                            fmi3Boolean* early_return, fmi3Float64* last_successful_time_s))

/* The functions of other interface types, and of capabilities that an FMU need not have: X(name, parameters) for each,
 * which declares it here and refuses it there. */
#define CRANKLOOP_FMI3_OTHERS(X)                                                                                       \
  X(fmi3EnterConfigurationMode, (fmi3Instance c))                                                                      \
  X(fmi3ExitConfigurationMode, (fmi3Instance c))                                                                       \
  X(fmi3EnterEventMode, (fmi3Instance c))                                                                              \
  X(fmi3EnterStepMode, (fmi3Instance c))                                                                               \
  X(fmi3EnterContinuousTimeMode, (fmi3Instance c))                                                                     \
  X(fmi3EvaluateDiscreteStates, (fmi3Instance c))                                                                      \
  X(fmi3UpdateDiscreteStates,                                                                                          \
    (fmi3Instance c, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*, fmi3Float64*))              \
  X(fmi3CompletedIntegratorStep, (fmi3Instance c, fmi3Boolean, fmi3Boolean*, fmi3Boolean*))                            \
  X(fmi3SetTime, (fmi3Instance c, fmi3Float64))                                                                        \
  X(fmi3SetContinuousStates, (fmi3Instance c, const fmi3Float64[], size_t))                                            \
  X(fmi3GetContinuousStateDerivatives, (fmi3Instance c, fmi3Float64[], size_t))                                        \
  X(fmi3GetEventIndicators, (fmi3Instance c, fmi3Float64[], size_t))                                                   \
  X(fmi3GetContinuousStates, (fmi3Instance c, fmi3Float64[], size_t))                                                  \
  X(fmi3GetNominalsOfContinuousStates, (fmi3Instance c, fmi3Float64[], size_t))                                        \
  X(fmi3GetNumberOfEventIndicators, (fmi3Instance c, size_t*))                                                         \
  X(fmi3GetNumberOfContinuousStates, (fmi3Instance c, size_t*))                                                        \
  X(fmi3GetOutputDerivatives,                                                                                          \
    (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3Int32[], fmi3Float64[], size_t))                    \
  X(fmi3GetDirectionalDerivative, (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3ValueReference[],     \
                                   size_t, const fmi3Float64[], size_t, fmi3Float64[], size_t))                        \
  X(fmi3GetAdjointDerivative, (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3ValueReference[], size_t, \
                               const fmi3Float64[], size_t, fmi3Float64[], size_t))                                    \
  X(fmi3GetNumberOfVariableDependencies, (fmi3Instance c, fmi3ValueReference, size_t*))                                \
  X(fmi3GetVariableDependencies,                                                                                       \
    (fmi3Instance c, fmi3ValueReference, size_t[], fmi3ValueReference[], size_t[], fmi3DependencyKind[], size_t))      \
  X(fmi3GetIntervalDecimal,                                                                                            \
    (fmi3Instance c, const fmi3ValueReference[], size_t, fmi3Float64[], fmi3IntervalQualifier[]))                      \
  X(fmi3GetIntervalFraction,                                                                                           \
    (fmi3Instance c, const fmi3ValueReference[], size_t, fmi3UInt64[], fmi3UInt64[], fmi3IntervalQualifier[]))         \
  X(fmi3GetShiftDecimal, (fmi3Instance c, const fmi3ValueReference[], size_t, fmi3Float64[]))                          \
  X(fmi3GetShiftFraction, (fmi3Instance c, const fmi3ValueReference[], size_t, fmi3UInt64[], fmi3UInt64[]))            \
  X(fmi3SetIntervalDecimal, (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3Float64[]))                 \
  X(fmi3SetIntervalFraction,                                                                                           \
    (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3UInt64[], const fmi3UInt64[]))                      \
  X(fmi3SetShiftDecimal, (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3Float64[]))                    \
  X(fmi3SetShiftFraction,                                                                                              \
    (fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3UInt64[], const fmi3UInt64[]))                      \
  X(fmi3ActivateModelPartition, (fmi3Instance c, fmi3ValueReference, fmi3Float64))
CRANKLOOP_FMI3_OTHERS(CRANKLOOP_FMI3)

#undef CRANKLOOP_FMI3
#undef CRANKLOOP_FMI3_TYPE
#undef CRANKLOOP_FMI3_WHICH

#ifdef __cplusplus
}

static_assert(sizeof(fmi3Boolean) == 1 && sizeof(fmi3Clock) == 1 && sizeof(fmi3ValueReference) == 4);
static_assert(sizeof(fmi3Float64) == 8 && sizeof(fmi3Float32) == 4 && sizeof(fmi3Status) == 4);
#endif

#endif

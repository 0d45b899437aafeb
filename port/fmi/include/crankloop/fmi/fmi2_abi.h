/* FMI 2.0 for co-simulation, as far as a binary interface needs it: types, constants, and every function that the
 * standard's headers name, for C99 and C++. In our own words, from the specification's tables; no text of the official
 * headers.
 *
 * Where the official headers are at hand, tests compare prototype by prototype (tests/fmi).
 */
#ifndef CRANKLOOP_FMI2_ABI_H
#define CRANKLOOP_FMI2_ABI_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define CRANKLOOP_FMI2_API __declspec(dllexport)
#else
#define CRANKLOOP_FMI2_API __attribute__((visibility("default")))
#endif

typedef void* fmi2Component;
typedef void* fmi2ComponentEnvironment;
typedef void* fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean; /* 0 or 1 */
typedef char fmi2Char;
typedef const fmi2Char* fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;

typedef struct {
  fmi2Boolean newDiscreteStatesNeeded, terminateSimulation;
  fmi2Boolean nominalsOfContinuousStatesChanged, valuesOfContinuousStatesChanged, nextEventTimeDefined;
  fmi2Real nextEventTime;
} fmi2EventInfo;

typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment, fmi2String instance, fmi2Status, fmi2String category,
                                   fmi2String message, ...);
typedef struct {
  fmi2CallbackLogger logger;
  void* (*allocateMemory)(size_t count, size_t bytes);
  void (*freeMemory)(void*);
  void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
  fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

#define CRANKLOOP_FMI2(name, arguments) CRANKLOOP_FMI2_API fmi2Status name arguments;

CRANKLOOP_FMI2_API const char* fmi2GetTypesPlatform(void);
CRANKLOOP_FMI2_API const char* fmi2GetVersion(void);
CRANKLOOP_FMI2_API fmi2Component fmi2Instantiate(fmi2String name, fmi2Type, fmi2String guid, fmi2String resource_uri,
                                                 const fmi2CallbackFunctions*, fmi2Boolean visible,
                                                 fmi2Boolean logging_on);
CRANKLOOP_FMI2_API void fmi2FreeInstance(fmi2Component);
CRANKLOOP_FMI2(fmi2SetDebugLogging, (fmi2Component, fmi2Boolean on, size_t count, const fmi2String categories[]))
CRANKLOOP_FMI2(fmi2SetupExperiment, (fmi2Component, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start_s,
                                     fmi2Boolean has_stop, fmi2Real stop_s))
CRANKLOOP_FMI2(fmi2EnterInitializationMode, (fmi2Component))
CRANKLOOP_FMI2(fmi2ExitInitializationMode, (fmi2Component))
CRANKLOOP_FMI2(fmi2Terminate, (fmi2Component))
CRANKLOOP_FMI2(fmi2Reset, (fmi2Component))

CRANKLOOP_FMI2(fmi2GetReal, (fmi2Component, const fmi2ValueReference[], size_t, fmi2Real[]))
CRANKLOOP_FMI2(fmi2GetInteger, (fmi2Component, const fmi2ValueReference[], size_t, fmi2Integer[]))
CRANKLOOP_FMI2(fmi2GetBoolean, (fmi2Component, const fmi2ValueReference[], size_t, fmi2Boolean[]))
CRANKLOOP_FMI2(fmi2GetString, (fmi2Component, const fmi2ValueReference[], size_t, fmi2String[]))
CRANKLOOP_FMI2(fmi2SetReal, (fmi2Component, const fmi2ValueReference[], size_t, const fmi2Real[]))
CRANKLOOP_FMI2(fmi2SetInteger, (fmi2Component, const fmi2ValueReference[], size_t, const fmi2Integer[]))
CRANKLOOP_FMI2(fmi2SetBoolean, (fmi2Component, const fmi2ValueReference[], size_t, const fmi2Boolean[]))
CRANKLOOP_FMI2(fmi2SetString, (fmi2Component, const fmi2ValueReference[], size_t, const fmi2String[]))

CRANKLOOP_FMI2(fmi2GetFMUstate, (fmi2Component, fmi2FMUstate*))
CRANKLOOP_FMI2(fmi2SetFMUstate, (fmi2Component, fmi2FMUstate))
CRANKLOOP_FMI2(fmi2FreeFMUstate, (fmi2Component, fmi2FMUstate*))
CRANKLOOP_FMI2(fmi2SerializedFMUstateSize, (fmi2Component, fmi2FMUstate, size_t*))
CRANKLOOP_FMI2(fmi2SerializeFMUstate, (fmi2Component, fmi2FMUstate, fmi2Byte[], size_t))
CRANKLOOP_FMI2(fmi2DeSerializeFMUstate, (fmi2Component, const fmi2Byte[], size_t, fmi2FMUstate*))
CRANKLOOP_FMI2(fmi2DoStep, (fmi2Component, fmi2Real time_s, fmi2Real step_s, fmi2Boolean no_set_state_before))
CRANKLOOP_FMI2(fmi2GetStatus, (fmi2Component, const fmi2StatusKind, fmi2Status*))
CRANKLOOP_FMI2(fmi2GetRealStatus, (fmi2Component, const fmi2StatusKind, fmi2Real*))
CRANKLOOP_FMI2(fmi2GetIntegerStatus, (fmi2Component, const fmi2StatusKind, fmi2Integer*))
CRANKLOOP_FMI2(fmi2GetBooleanStatus, (fmi2Component, const fmi2StatusKind, fmi2Boolean*))
CRANKLOOP_FMI2(fmi2GetStringStatus, (fmi2Component, const fmi2StatusKind, fmi2String*))

/* The functions of model exchange, and of capabilities that an FMU need not have: X(name, parameters) for each, which
 * declares it here and refuses it there. */
#define CRANKLOOP_FMI2_OTHERS(X)                                                                                    \
  X(fmi2CancelStep, (fmi2Component c))                                                                              \
  X(fmi2SetRealInputDerivatives,                                                                                    \
    (fmi2Component c, const fmi2ValueReference[], size_t, const fmi2Integer[], const fmi2Real[]))                   \
  X(fmi2GetRealOutputDerivatives,                                                                                   \
    (fmi2Component c, const fmi2ValueReference[], size_t, const fmi2Integer[], fmi2Real[]))                         \
  X(fmi2GetDirectionalDerivative, (fmi2Component c, const fmi2ValueReference[], size_t, const fmi2ValueReference[], \
                                   size_t, const fmi2Real[], fmi2Real[]))                                           \
  X(fmi2EnterEventMode, (fmi2Component c))                                                                          \
  X(fmi2NewDiscreteStates, (fmi2Component c, fmi2EventInfo*))                                                       \
  X(fmi2EnterContinuousTimeMode, (fmi2Component c))                                                                 \
  X(fmi2CompletedIntegratorStep, (fmi2Component c, fmi2Boolean, fmi2Boolean*, fmi2Boolean*))                        \
  X(fmi2SetTime, (fmi2Component c, fmi2Real))                                                                       \
  X(fmi2SetContinuousStates, (fmi2Component c, const fmi2Real[], size_t))                                           \
  X(fmi2GetDerivatives, (fmi2Component c, fmi2Real[], size_t))                                                      \
  X(fmi2GetEventIndicators, (fmi2Component c, fmi2Real[], size_t))                                                  \
  X(fmi2GetContinuousStates, (fmi2Component c, fmi2Real[], size_t))                                                 \
  X(fmi2GetNominalsOfContinuousStates, (fmi2Component c, fmi2Real[], size_t))
CRANKLOOP_FMI2_OTHERS(CRANKLOOP_FMI2)

#undef CRANKLOOP_FMI2

#ifdef __cplusplus
}

static_assert(sizeof(fmi2Boolean) == 4 && sizeof(fmi2Integer) == 4 && sizeof(fmi2ValueReference) == 4);
static_assert(sizeof(fmi2Real) == 8 && sizeof(fmi2Status) == 4 && sizeof(fmi2Type) == 4);
static_assert(sizeof(fmi2CallbackFunctions) == 5 * sizeof(void*) && sizeof(fmi2EventInfo) == 32);
#endif

#endif

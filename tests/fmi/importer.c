/* dlopen and dlsym are POSIX. */
#define _POSIX_C_SOURCE 200809L
#include "importer.h"

#include <crankloop/fmi/fmi2_abi.h>
#include <crankloop/fmi/fmi3_abi.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include "functions.h"

#define NAME(name) #name,
static const char* const kFunctions2[] = {FMI2_FUNCTIONS(NAME)};
static const char* const kFunctions3[] = {FMI3_FUNCTIONS(NAME)};

struct importer {
  void* object;
  int version;
};
struct unit {
  struct importer* from;
  void* handle;
  double start_s;
};

static char message[4096];

const char* importer_message(void) {
  static char read[sizeof message];
  memcpy(read, message, sizeof read);
  message[0] = '\0';
  return read;
}

static void heed2(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                  fmi2String format, ...) {
  va_list arguments;
  va_start(arguments, format);
  (void)environment, (void)instance, (void)status, (void)category;
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
}
static void heed3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String text) {
  (void)environment, (void)status, (void)category;
  snprintf(message, sizeof message, "%s", text);
}

typedef void (*function)(void);

/* What the system loads objects by. Paths are UTF-8. */
#if defined(_WIN32)
static void* open_object(const char* path) {
  wchar_t wide[4096];
  if (MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, sizeof wide / sizeof *wide) == 0) return NULL;
  return LoadLibraryW(wide);
}
static void tell_why_not_open(const char* path) { fprintf(stderr, "%s: error %lu\n", path, GetLastError()); }
static void close_object(void* object) { FreeLibrary(object); }
static function find_in(void* object, const char* name) {
  function found;
  FARPROC at = GetProcAddress(object, name);
  memcpy(&found, &at, sizeof found);
  return found;
}
static const char kRootOfUri[] = "file:///"; /* before C:/... */
#else
static void* open_object(const char* path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void tell_why_not_open(const char* path) { fprintf(stderr, "%s: %s\n", path, dlerror()); }
static void close_object(void* object) { dlclose(object); }
static function find_in(void* object, const char* name) { /* ISO C has no conversion from an object's address */
  function found;
  void* at = dlsym(object, name);
  memcpy(&found, &at, sizeof found);
  return found;
}
static const char kRootOfUri[] = "file://";
#endif

/* A function of the object by its name in the version. */
static function find(const struct importer* from, const char* name) {
  char whole[80];
  snprintf(whole, sizeof whole, "fmi%d%s", from->version, name);
  return find_in(from->object, whole);
}
/* `type` is that of the ABI header's declaration. */
#define CALL2(unit, name) ((__typeof__(&fmi2##name))find((unit)->from, #name))
#define CALL3(unit, name) ((__typeof__(&fmi3##name))find((unit)->from, #name))
#define TWO(unit) ((unit)->from->version == 2)

struct importer* importer_load(const char* shared_object, int version) {
  struct importer* importer = malloc(sizeof *importer);
  const char* const* names = version == 2 ? kFunctions2 : kFunctions3;
  const size_t count =
      version == 2 ? sizeof kFunctions2 / sizeof *kFunctions2 : sizeof kFunctions3 / sizeof *kFunctions3;
  size_t i;
  importer->object = open_object(shared_object);
  importer->version = version;
  if (importer->object == NULL) {
    tell_why_not_open(shared_object);
    free(importer);
    return NULL;
  }
  for (i = 0; i < count; ++i) {
    if (find(importer, names[i]) == NULL) {
      fprintf(stderr, "%s lacks fmi%d%s\n", shared_object, version, names[i]);
      importer_unload(importer);
      return NULL;
    }
  }
  return importer;
}
void importer_unload(struct importer* importer) {
  close_object(importer->object);
  free(importer);
}

struct unit* unit_create(struct importer* importer, const char* name, const char* token, const char* resources) {
  struct unit* unit = calloc(1, sizeof *unit);
  static const fmi2CallbackFunctions callbacks = {heed2, calloc, free, NULL, NULL};
  char uri[4096];
  unit->from = importer;
  if (TWO(unit)) {
    size_t at = (size_t)snprintf(uri, sizeof uri, "%s", kRootOfUri);
    const char* c;
    for (c = resources == NULL ? "/" : resources; *c != '\0' && at + 4 < sizeof uri; ++c) {
      const unsigned char byte = (unsigned char)(*c == '\\' ? '/' : *c);
      const bool as_it_is = byte > ' ' && byte < 0x7F && byte != '%';
      at += (size_t)snprintf(uri + at, sizeof uri - at, as_it_is ? "%c" : "%%%02X", byte);
    }
    unit->handle = CALL2(unit, Instantiate)(name, fmi2CoSimulation, token, uri, &callbacks, 0, 0);
  } else {
    unit->handle = CALL3(unit, InstantiateCoSimulation)(name, token, resources, false, false, false, false, NULL, 0,
                                                        NULL, heed3, NULL);
  }
  if (unit->handle != NULL) return unit;
  free(unit);
  return NULL;
}
bool importer_is_refused(struct importer* importer, const char* token, bool events, size_t intermediate) {
  const fmi3ValueReference which[] = {0, 1};
  struct unit unit = {0};
  unit.from = importer;
  unit.handle = CALL3(&unit, InstantiateCoSimulation)("a unit", token, "/", false, false, events, false, which,
                                                      intermediate, NULL, heed3, NULL);
  if (unit.handle == NULL) return true;
  CALL3(&unit, FreeInstance)(unit.handle);
  return false;
}
void unit_free(struct unit* unit) {
  if (TWO(unit)) {
    CALL2(unit, FreeInstance)(unit->handle);
  } else {
    CALL3(unit, FreeInstance)(unit->handle);
  }
  free(unit);
}

int unit_setup(struct unit* unit, double start_s) {
  unit->start_s = start_s;
  return TWO(unit) ? (int)CALL2(unit, SetupExperiment)(unit->handle, 0, 0, start_s, 0, 0) : UNIT_OK;
}
int unit_begin(struct unit* unit) {
  return TWO(unit) ? (int)CALL2(unit, EnterInitializationMode)(unit->handle)
                   : (int)CALL3(unit, EnterInitializationMode)(unit->handle, false, 0, unit->start_s, false, 0);
}

/* What both versions call alike. */
#define BOTH(name, arguments) return TWO(unit) ? (int)CALL2(unit, name) arguments : (int)CALL3(unit, name) arguments
int unit_start(struct unit* unit) { BOTH(ExitInitializationMode, (unit->handle)); }
int unit_log(struct unit* unit, bool on, const char* category) {
  const size_t n = category == NULL ? 0 : 1;
  return TWO(unit) ? (int)CALL2(unit, SetDebugLogging)(unit->handle, on, n, &category)
                   : (int)CALL3(unit, SetDebugLogging)(unit->handle, on, n, &category);
}
int unit_terminate(struct unit* unit) { BOTH(Terminate, (unit->handle)); }
int unit_reset(struct unit* unit) { BOTH(Reset, (unit->handle)); }

int unit_step(struct unit* unit, double time_s, double step_s) {
  bool flags[3] = {true, true, true};
  double last_s = -1;
  int status;
  if (TWO(unit)) return (int)CALL2(unit, DoStep)(unit->handle, time_s, step_s, 0);
  status = (int)CALL3(unit, DoStep)(unit->handle, time_s, step_s, false, flags, flags + 1, flags + 2, &last_s);
  if (status == UNIT_OK && (flags[0] || flags[1] || flags[2] || last_s != time_s + step_s)) {
    fprintf(stderr, "fmi3DoStep: flags or last successful time are wrong\n");
    abort();
  }
  return status;
}

int unit_step_many(struct unit* unit, double time_s, double step_s, long count) {
  int status = UNIT_OK;
  long k;
  if (TWO(unit)) {
    __typeof__(&fmi2DoStep) step = CALL2(unit, DoStep);
    for (k = 0; status == UNIT_OK && k < count; ++k)
      status = (int)step(unit->handle, time_s + (double)k * step_s, step_s, 0);
  } else {
    __typeof__(&fmi3DoStep) step = CALL3(unit, DoStep);
    bool flags[3];
    double last_s;
    for (k = 0; status == UNIT_OK && k < count; ++k) {
      status =
          (int)step(unit->handle, time_s + (double)k * step_s, step_s, false, flags, flags + 1, flags + 2, &last_s);
    }
  }
  return status;
}

int unit_get_real(struct unit* unit, const uint32_t* which, size_t n, double* values) {
  return TWO(unit) ? (int)CALL2(unit, GetReal)(unit->handle, which, n, values)
                   : (int)CALL3(unit, GetFloat64)(unit->handle, which, n, values, n);
}
int unit_set_real(struct unit* unit, const uint32_t* which, size_t n, const double* values) {
  return TWO(unit) ? (int)CALL2(unit, SetReal)(unit->handle, which, n, values)
                   : (int)CALL3(unit, SetFloat64)(unit->handle, which, n, values, n);
}
int unit_get_whole(struct unit* unit, const uint32_t* which, size_t n, uint32_t* values) {
  return TWO(unit) ? (int)CALL2(unit, GetInteger)(unit->handle, which, n, (fmi2Integer*)values)
                   : (int)CALL3(unit, GetUInt32)(unit->handle, which, n, values, n);
}
int unit_set_whole(struct unit* unit, const uint32_t* which, size_t n, const uint32_t* values) {
  return TWO(unit) ? (int)CALL2(unit, SetInteger)(unit->handle, which, n, (const fmi2Integer*)values)
                   : (int)CALL3(unit, SetUInt32)(unit->handle, which, n, values, n);
}
enum { kMaxTruths = 4096 };
int unit_get_truth(struct unit* unit, const uint32_t* which, size_t n, int* values) {
  static bool bytes[kMaxTruths];
  int status;
  size_t i;
  if (TWO(unit)) return (int)CALL2(unit, GetBoolean)(unit->handle, which, n, values);
  if (n > kMaxTruths) return UNIT_ERROR;
  status = (int)CALL3(unit, GetBoolean)(unit->handle, which, n, bytes, n);
  for (i = 0; status == UNIT_OK && i < n; ++i) values[i] = bytes[i];
  return status;
}
int unit_set_truth(struct unit* unit, const uint32_t* which, size_t n, const int* values) {
  static bool bytes[kMaxTruths];
  size_t i;
  if (TWO(unit)) return (int)CALL2(unit, SetBoolean)(unit->handle, which, n, values);
  if (n > kMaxTruths) return UNIT_ERROR;
  for (i = 0; i < n; ++i) bytes[i] = values[i] != 0;
  return (int)CALL3(unit, SetBoolean)(unit->handle, which, n, bytes, n);
}

#define STATE(name2, name3, arguments) \
  return TWO(unit) ? (int)CALL2(unit, name2) arguments : (int)CALL3(unit, name3) arguments
int unit_get_state(struct unit* unit, void** state) { STATE(GetFMUstate, GetFMUState, (unit->handle, state)); }
int unit_set_state(struct unit* unit, void* state) { STATE(SetFMUstate, SetFMUState, (unit->handle, state)); }
int unit_free_state(struct unit* unit, void** state) { STATE(FreeFMUstate, FreeFMUState, (unit->handle, state)); }
int unit_state_size(struct unit* unit, void* state, size_t* size) {
  STATE(SerializedFMUstateSize, SerializedFMUStateSize, (unit->handle, state, size));
}
int unit_write_state(struct unit* unit, void* state, unsigned char* bytes, size_t size) {
  return TWO(unit) ? (int)CALL2(unit, SerializeFMUstate)(unit->handle, state, (fmi2Byte*)bytes, size)
                   : (int)CALL3(unit, SerializeFMUState)(unit->handle, state, bytes, size);
}
int unit_read_state(struct unit* unit, const unsigned char* bytes, size_t size, void** state) {
  return TWO(unit) ? (int)CALL2(unit, DeSerializeFMUstate)(unit->handle, (const fmi2Byte*)bytes, size, state)
                   : (int)CALL3(unit, DeserializeFMUState)(unit->handle, bytes, size, state);
}

int unit_call_other(struct unit* unit, int which) {
  static double number;
  static size_t size;
  if (TWO(unit)) {
    switch (which) {
      case 0:
        return (int)CALL2(unit, EnterEventMode)(unit->handle);
      case 1:
        return (int)CALL2(unit, SetTime)(unit->handle, 1);
      case 2:
        return (int)CALL2(unit, GetDerivatives)(unit->handle, &number, 1);
      case 3:
        return (int)CALL2(unit, CancelStep)(unit->handle);
      case 4:
        return (int)CALL2(unit, EnterContinuousTimeMode)(unit->handle);
      case 5:
        return (int)CALL2(unit, GetDirectionalDerivative)(unit->handle, NULL, 0, NULL, 0, NULL, NULL);
      case 6:
        return (int)CALL2(unit, SetRealInputDerivatives)(unit->handle, NULL, 0, NULL, NULL);
      default:
        return -1;
    }
  }
  switch (which) {
    case 0:
      return (int)CALL3(unit, EnterEventMode)(unit->handle);
    case 1:
      return (int)CALL3(unit, SetTime)(unit->handle, 1);
    case 2:
      return (int)CALL3(unit, EnterStepMode)(unit->handle);
    case 3:
      return (int)CALL3(unit, EnterConfigurationMode)(unit->handle);
    case 4:
      return (int)CALL3(unit, GetNumberOfContinuousStates)(unit->handle, &size);
    case 5:
      return (int)CALL3(unit, GetNumberOfVariableDependencies)(unit->handle, 0, &size);
    case 6:
      return (int)CALL3(unit, ActivateModelPartition)(unit->handle, 0, 0);
    default:
      return -1;
  }
}

// The C interface in float.
#define CRANKLOOP_REAL float
#define CRANKLOOP_C(name) crankloop_f_##name
#define CRANKLOOP_SAVED_BYTES CRANKLOOP_F_SAVED_BYTES
#include "engine_glue.inc"

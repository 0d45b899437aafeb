// The C interface in double.
#define CRANKLOOP_REAL double
#define CRANKLOOP_C(name) crankloop_d_##name
#define CRANKLOOP_SAVED_BYTES CRANKLOOP_D_SAVED_BYTES
#include "engine_glue.inc"

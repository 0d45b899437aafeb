/* An importer of FMUs in C99: loads the shared object, and calls either version's functions by one set of names. What a
 * simulator does, and no more: it knows the object's path and the model description's token.
 */
#ifndef IMPORTER_H
#define IMPORTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct importer; /* a shared object, one of its versions */
struct unit;     /* an instance */

enum { UNIT_OK = 0, UNIT_DISCARD = 2, UNIT_ERROR = 3 };

/* NULL where a function that the version's headers name is missing. */
struct importer* importer_load(const char* shared_object, int version);
void importer_unload(struct importer* importer);

/* Resources: a folder's path; FMI 2 gets it as a URI. NULL: refused. */
struct unit* unit_create(struct importer* importer, const char* name, const char* token, const char* resources);
void unit_free(struct unit* unit);

/* FMI 3: whether the FMU makes no instance for a simulator that wants events, or so many intermediate values. */
bool importer_is_refused(struct importer* importer, const char* token, bool events, size_t intermediate);

/* The last message that the instance, or an attempt to make one, sent; "" none. Cleared by reading. */
const char* importer_message(void);

int unit_setup(struct unit* unit, double start_s); /* FMI 2; in FMI 3 remembered for the next */
int unit_begin(struct unit* unit);
int unit_start(struct unit* unit);
int unit_log(struct unit* unit, bool on, const char* category); /* NULL: every category */
int unit_terminate(struct unit* unit);
int unit_reset(struct unit* unit);
int unit_step(struct unit* unit, double time_s, double step_s);
/* As many steps as `count`, one behind the other, by a function that is looked up once: nothing but the steps. */
int unit_step_many(struct unit* unit, double time_s, double step_s, long count);

int unit_get_real(struct unit* unit, const uint32_t* which, size_t n, double* values);
int unit_get_whole(struct unit* unit, const uint32_t* which, size_t n, uint32_t* values);
int unit_get_truth(struct unit* unit, const uint32_t* which, size_t n, int* values);
int unit_set_real(struct unit* unit, const uint32_t* which, size_t n, const double* values);
int unit_set_whole(struct unit* unit, const uint32_t* which, size_t n, const uint32_t* values);
int unit_set_truth(struct unit* unit, const uint32_t* which, size_t n, const int* values);

int unit_get_state(struct unit* unit, void** state);
int unit_set_state(struct unit* unit, void* state);
int unit_free_state(struct unit* unit, void** state);
int unit_state_size(struct unit* unit, void* state, size_t* size);
int unit_write_state(struct unit* unit, void* state, unsigned char* bytes, size_t size);
int unit_read_state(struct unit* unit, const unsigned char* bytes, size_t size, void** state);

/* Calls of functions that the FMU cannot have: `which` counts them, from 0; -1 behind the last. */
int unit_call_other(struct unit* unit, int which);

#ifdef __cplusplus
}
#endif
#endif

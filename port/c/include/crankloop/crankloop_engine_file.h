/* Engine files (tools/engines/diesel_495.ini) for C and for languages that call C, on a host: a library of its own,
 * which uses the heap and the C++ library. In CMake target crankloop::engine_file.
 */
#ifndef CRANKLOOP_CRANKLOOP_ENGINE_FILE_H
#define CRANKLOOP_CRANKLOOP_ENGINE_FILE_H

#include <crankloop/crankloop.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct crankloop_engine_file crankloop_engine_file; /* an engine that was read */

/* Reads the engine in the `text_size` bytes at `text`, or in the file at `path` where `text` is null. The path stands
 * in messages, and what the text names by "file = ..." is looked for beside it. Null: refused, and `errors` has the
 * lines "path:line: what is wrong", one for each error that does not follow from another, cut to `room` with their
 * closing 0; empty else. */
CRANKLOOP_API crankloop_engine_file* crankloop_engine_file_read(const char* path, const char* text, size_t text_size,
                                                                char* errors, size_t room);

/* Its definition, complete and valid, for NAME_tables_create(); `size`, unless null, is set to its size. It lives, with
 * the rows that it points to, as long as `file`. Null of null. */
CRANKLOOP_API const crankloop_definition* crankloop_engine_file_definition(const crankloop_engine_file* file,
                                                                           size_t* size);

/* Of null: nothing. */
CRANKLOOP_API void crankloop_engine_file_free(crankloop_engine_file* file);

#ifdef __cplusplus
}
#endif

#endif

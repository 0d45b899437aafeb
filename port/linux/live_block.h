/* The block of memory of `crankloop live` in C99: where everything is, and how to follow its edges. docs/live.md says
 * what it means.
 *
 *     const void* block = mmap(...);                                  the whole file
 *     if (crankloop_live_refusal(block, bytes) != NULL) ...           of no or another version, not ready, cut off
 *     struct crankloop_live_edge_reader reader;
 *     crankloop_live_edges_begin(block, &reader);                     with the edges that are yet to come
 *     n = crankloop_live_edges_read(&reader, edges, 64);              never waits; reader.lost says what was missed
 *
 * What belongs here: the layout, and reading it without waiting. What does not: files and maps (a program's own).
 * It needs nothing else of crankloop, and GCC's or Clang's __atomic built-ins, which C99 lacks. */
#ifndef CRANKLOOP_LINUX_LIVE_BLOCK_H
#define CRANKLOOP_LINUX_LIVE_BLOCK_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CRANKLOOP_LIVE_MAGIC 0x4C4B5243u /* the bytes "CRKL" where the lowest comes first */
#define CRANKLOOP_LIVE_VERSION 4u        /* another layout has another number */
#define CRANKLOOP_LIVE_FIXED_BYTES 256u  /* of the fixed part, before the sections */

enum { CRANKLOOP_LIVE_STARTING = 0, CRANKLOOP_LIVE_RUNNING = 1, CRANKLOOP_LIVE_ENDED = 2 };

/* Kinds of sections. A reader leaves out those that it does not know. */
enum {
  CRANKLOOP_LIVE_SIGNAL_NAMES = 1, /* `count` texts of 48 bytes, the rest of each 0 */
  CRANKLOOP_LIVE_SIGNALS = 2,      /* struct crankloop_live_numbers with `count` numbers, written by live */
  CRANKLOOP_LIVE_INPUT_NAMES = 3,
  CRANKLOOP_LIVE_INPUTS = 4, /* as the signals, written by the controller */
  CRANKLOOP_LIVE_WHEEL_NAMES = 5,
  CRANKLOOP_LIVE_EDGES = 6 /* struct crankloop_live_edges with room for `count` edges, a power of two */
};
#define CRANKLOOP_LIVE_NAME_BYTES 48u

struct crankloop_live_section {
  uint32_t kind;
  uint32_t offset; /* in bytes, from the start of the block; a multiple of 64 */
  uint32_t count;
  uint32_t entry_bytes; /* of each of the `count` */
};

struct crankloop_live_inputs {
  double load_ratio;
  double external_torque_Nm;
  uint32_t starter;
  uint32_t cut_cylinders;
  double throttle_ratio;
  double fuel_kg;
  double burn_start_deg;
  double excess_air_ratio;
};

struct crankloop_live_outputs {
  uint64_t ticks;
  double time_s;
  double speed_rad_s;
  double acceleration_rad_s2;
  double crank_deg;
  double torque_Nm;
  double mean_torque_Nm;
  double friction_Nm;
  double starter_Nm;
  uint32_t faults;
  uint32_t flags;
  uint32_t inputs_sequence;
  uint32_t torn_inputs;
  uint64_t late_ticks;
  uint64_t missed_deadlines;
  double intake_Pa;
  double trapped_air_kg;
};

struct crankloop_live_block {
  uint32_t magic; /* written last: before that nothing in the block is valid */
  uint32_t version;
  uint32_t size_bytes; /* of the whole file */
  uint32_t state;
  double tick_s;
  uint32_t cylinders;
  uint32_t breathes;
  uint32_t section_count;
  uint32_t section_list; /* offset of `section_count` struct crankloop_live_section */
  uint32_t unused[6];
  uint32_t inputs_sequence;
  uint32_t unused_inputs;
  struct crankloop_live_inputs inputs;
  uint32_t outputs_sequence;
  uint32_t unused_outputs;
  struct crankloop_live_outputs outputs;
};

/* Signals and inputs: a sequence number, and 8 bytes on as many doubles as the section's count. */
struct crankloop_live_numbers {
  uint32_t sequence;
  uint32_t unused;
};

struct crankloop_live_edge {
  uint64_t due_ns; /* by CLOCK_MONOTONIC */
  uint32_t wheel;  /* from 0, in the order of the engine file */
  uint32_t level;  /* after the edge: 1 it rose, 0 it fell */
};

/* The ring: edge n is entry n mod `count`, 64 bytes after its begin. */
struct crankloop_live_edges {
  uint64_t written; /* so far; counted up after the entry is there */
  uint64_t unused[7];
};

/* C99 has no static_assert: an array of -1 elements is refused. */
#define CRANKLOOP_LIVE_ASSERT(name, claim) typedef char crankloop_live_assert_##name[(claim) ? 1 : -1]
#define CRANKLOOP_LIVE_AT(type, member, bytes) \
  CRANKLOOP_LIVE_ASSERT(type##_##member, offsetof(struct crankloop_live_##type, member) == (bytes))
CRANKLOOP_LIVE_ASSERT(double_is_of_8_bytes, sizeof(double) == 8);
CRANKLOOP_LIVE_AT(section, kind, 0);
CRANKLOOP_LIVE_AT(section, offset, 4);
CRANKLOOP_LIVE_AT(section, count, 8);
CRANKLOOP_LIVE_AT(section, entry_bytes, 12);
CRANKLOOP_LIVE_ASSERT(section_size, sizeof(struct crankloop_live_section) == 16);
CRANKLOOP_LIVE_AT(inputs, load_ratio, 0);
CRANKLOOP_LIVE_AT(inputs, external_torque_Nm, 8);
CRANKLOOP_LIVE_AT(inputs, starter, 16);
CRANKLOOP_LIVE_AT(inputs, cut_cylinders, 20);
CRANKLOOP_LIVE_AT(inputs, throttle_ratio, 24);
CRANKLOOP_LIVE_AT(inputs, fuel_kg, 32);
CRANKLOOP_LIVE_AT(inputs, burn_start_deg, 40);
CRANKLOOP_LIVE_AT(inputs, excess_air_ratio, 48);
CRANKLOOP_LIVE_ASSERT(inputs_size, sizeof(struct crankloop_live_inputs) == 56);
CRANKLOOP_LIVE_AT(outputs, ticks, 0);
CRANKLOOP_LIVE_AT(outputs, time_s, 8);
CRANKLOOP_LIVE_AT(outputs, speed_rad_s, 16);
CRANKLOOP_LIVE_AT(outputs, acceleration_rad_s2, 24);
CRANKLOOP_LIVE_AT(outputs, crank_deg, 32);
CRANKLOOP_LIVE_AT(outputs, torque_Nm, 40);
CRANKLOOP_LIVE_AT(outputs, mean_torque_Nm, 48);
CRANKLOOP_LIVE_AT(outputs, friction_Nm, 56);
CRANKLOOP_LIVE_AT(outputs, starter_Nm, 64);
CRANKLOOP_LIVE_AT(outputs, faults, 72);
CRANKLOOP_LIVE_AT(outputs, flags, 76);
CRANKLOOP_LIVE_AT(outputs, inputs_sequence, 80);
CRANKLOOP_LIVE_AT(outputs, torn_inputs, 84);
CRANKLOOP_LIVE_AT(outputs, late_ticks, 88);
CRANKLOOP_LIVE_AT(outputs, missed_deadlines, 96);
CRANKLOOP_LIVE_AT(outputs, intake_Pa, 104);
CRANKLOOP_LIVE_AT(outputs, trapped_air_kg, 112);
CRANKLOOP_LIVE_ASSERT(outputs_size, sizeof(struct crankloop_live_outputs) == 120);
CRANKLOOP_LIVE_AT(block, magic, 0);
CRANKLOOP_LIVE_AT(block, version, 4);
CRANKLOOP_LIVE_AT(block, size_bytes, 8);
CRANKLOOP_LIVE_AT(block, state, 12);
CRANKLOOP_LIVE_AT(block, tick_s, 16);
CRANKLOOP_LIVE_AT(block, cylinders, 24);
CRANKLOOP_LIVE_AT(block, breathes, 28);
CRANKLOOP_LIVE_AT(block, section_count, 32);
CRANKLOOP_LIVE_AT(block, section_list, 36);
CRANKLOOP_LIVE_AT(block, inputs_sequence, 64);
CRANKLOOP_LIVE_AT(block, inputs, 72);
CRANKLOOP_LIVE_AT(block, outputs_sequence, 128);
CRANKLOOP_LIVE_AT(block, outputs, 136);
CRANKLOOP_LIVE_ASSERT(block_size, sizeof(struct crankloop_live_block) == CRANKLOOP_LIVE_FIXED_BYTES);
CRANKLOOP_LIVE_ASSERT(numbers_size, sizeof(struct crankloop_live_numbers) == 8);
CRANKLOOP_LIVE_AT(edge, due_ns, 0);
CRANKLOOP_LIVE_AT(edge, wheel, 8);
CRANKLOOP_LIVE_AT(edge, level, 12);
CRANKLOOP_LIVE_ASSERT(edge_size, sizeof(struct crankloop_live_edge) == 16);
CRANKLOOP_LIVE_AT(edges, written, 0);
CRANKLOOP_LIVE_ASSERT(edges_size, sizeof(struct crankloop_live_edges) == 64);

/* Why a file of `bytes` bytes, mapped whole, cannot be used; NULL: it can. */
static inline const char* crankloop_live_refusal(const void* map, size_t bytes) {
  const struct crankloop_live_block* block = (const struct crankloop_live_block*)map;
  uint32_t magic, i;
  if (bytes < CRANKLOOP_LIVE_FIXED_BYTES) return "is no block of crankloop live";
  magic = __atomic_load_n(&block->magic, __ATOMIC_ACQUIRE);
  if (magic == 0) return "is not ready yet";
  if (magic != CRANKLOOP_LIVE_MAGIC) return "is no block of crankloop live";
  if (block->version != CRANKLOOP_LIVE_VERSION) return "is a block of another version of crankloop";
  if (block->size_bytes != bytes || block->section_list > bytes || block->section_list % 4 != 0 ||
      block->section_count > (bytes - block->section_list) / sizeof(struct crankloop_live_section))
    return "is a block that is not whole";
  for (i = 0; i < block->section_count; ++i) {
    struct crankloop_live_section section;
    uint64_t own;
    memcpy(&section, (const char*)map + block->section_list + i * sizeof section, sizeof section);
    own = (uint64_t)section.count * section.entry_bytes;
    if (section.kind == CRANKLOOP_LIVE_SIGNALS || section.kind == CRANKLOOP_LIVE_INPUTS)
      own += sizeof(struct crankloop_live_numbers);
    if (section.kind == CRANKLOOP_LIVE_EDGES) own += sizeof(struct crankloop_live_edges);
    if (section.offset % 64 != 0 || section.offset > bytes || own > bytes - section.offset)
      return "is a block that is not whole";
    if (section.kind == CRANKLOOP_LIVE_EDGES && (section.entry_bytes != sizeof(struct crankloop_live_edge) ||
                                                 section.count == 0 || (section.count & (section.count - 1)) != 0))
      return "is a block that is not whole";
  }
  return NULL;
}

/* The section of a kind, of a block that is not refused. Its count is 0 where there is none. */
static inline struct crankloop_live_section crankloop_live_find(const void* map, uint32_t kind) {
  const struct crankloop_live_block* block = (const struct crankloop_live_block*)map;
  struct crankloop_live_section section = {0, 0, 0, 0};
  uint32_t i;
  for (i = 0; i < block->section_count; ++i) {
    memcpy(&section, (const char*)map + block->section_list + i * sizeof section, sizeof section);
    if (section.kind == kind) return section;
  }
  memset(&section, 0, sizeof section);
  return section;
}

/* Index of a name in a section of names; its count: there is none. */
static inline uint32_t crankloop_live_index(const void* map, struct crankloop_live_section names, const char* name) {
  uint32_t i;
  for (i = 0; i < names.count; ++i) {
    const char* const entry = (const char*)map + names.offset + (size_t)i * names.entry_bytes;
    if (strncmp(entry, name, names.entry_bytes) == 0) return i;
  }
  return names.count;
}

/* Copies the `count` numbers of a section as they were after one write. One try: 0 while they are being written. */
static inline int crankloop_live_numbers_read(const void* map, struct crankloop_live_section section, double* numbers) {
  const struct crankloop_live_numbers* lock = (const struct crankloop_live_numbers*)((const char*)map + section.offset);
  const uint32_t* words = (const uint32_t*)(lock + 1);
  const uint32_t before = __atomic_load_n(&lock->sequence, __ATOMIC_ACQUIRE);
  uint32_t i;
  if (before % 2 != 0) return 0;
  for (i = 0; i < section.count; ++i) {
    uint32_t pair[2];
    pair[0] = __atomic_load_n(words + (size_t)2 * i, __ATOMIC_ACQUIRE);
    pair[1] = __atomic_load_n(words + (size_t)2 * i + 1, __ATOMIC_ACQUIRE);
    memcpy(numbers + i, pair, sizeof pair);
  }
  return __atomic_load_n(&lock->sequence, __ATOMIC_RELAXED) == before;
}

/* A reader's place in the ring. Every edge since its begin has been read or is lost: read + lost = written - begin. */
struct crankloop_live_edge_reader {
  const struct crankloop_live_edges* ring;
  const struct crankloop_live_edge* entry;
  uint64_t depth;
  uint64_t next; /* number of the edge that is read next */
  uint64_t read;
  uint64_t lost; /* overwritten before they were read */
};

/* The first edge that it will read is the next one written. 0: the engine has no trigger wheel. */
static inline int crankloop_live_edges_begin(const void* map, struct crankloop_live_edge_reader* reader) {
  const struct crankloop_live_section section = crankloop_live_find(map, CRANKLOOP_LIVE_EDGES);
  memset(reader, 0, sizeof *reader);
  if (section.count == 0) return 0;
  reader->ring = (const struct crankloop_live_edges*)((const char*)map + section.offset);
  reader->entry = (const struct crankloop_live_edge*)(reader->ring + 1);
  reader->depth = section.count;
  reader->next = __atomic_load_n(&reader->ring->written, __ATOMIC_ACQUIRE);
  return 1;
}

/* The first edge that cannot be overwritten while `written` is what the counter says: the writer may be at edge
 * `written`, in the place of edge `written - depth`. */
static inline uint64_t crankloop_live_oldest(uint64_t written, uint64_t depth) {
  return written < depth ? 0 : written - depth + 1;
}

/* Copies up to `most` edges in their order; returns how many. Never waits. Edges that were overwritten, before or while
 * they were copied, are counted in reader->lost. A counter that went back, which no live writes, reads as none. */
static inline size_t crankloop_live_edges_read(struct crankloop_live_edge_reader* reader,
                                               struct crankloop_live_edge* edges, size_t most) {
  uint64_t written = __atomic_load_n(&reader->ring->written, __ATOMIC_ACQUIRE);
  uint64_t oldest = crankloop_live_oldest(written, reader->depth);
  size_t count = 0, torn = 0, i;
  if (written < reader->next) return 0;
  if (oldest > reader->next) {
    reader->lost += oldest - reader->next;
    reader->next = oldest;
  }
  for (; count < most && reader->next + count < written; ++count) {
    const struct crankloop_live_edge* from = reader->entry + ((reader->next + count) & (reader->depth - 1));
    edges[count].due_ns = __atomic_load_n(&from->due_ns, __ATOMIC_ACQUIRE);
    edges[count].wheel = __atomic_load_n(&from->wheel, __ATOMIC_ACQUIRE);
    edges[count].level = __atomic_load_n(&from->level, __ATOMIC_ACQUIRE);
  }
  oldest = crankloop_live_oldest(__atomic_load_n(&reader->ring->written, __ATOMIC_ACQUIRE), reader->depth);
  if (oldest > reader->next) torn = oldest - reader->next < count ? (size_t)(oldest - reader->next) : count;
  for (i = torn; torn > 0 && i < count; ++i) edges[i - torn] = edges[i];
  reader->next += count;
  reader->lost += torn;
  reader->read += count - torn;
  return count - torn;
}

#ifdef __cplusplus
}
#endif

#endif

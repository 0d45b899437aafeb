/* Follows the edges of `crankloop live` in C99 until it ends, or for some seconds: edge_reader PATH SECONDS PAUSE_MS
 *
 * Says where it began, how many edges it read and lost, how many were written in all, and how many were wrong: that
 * came twice or not at all without being counted as lost (the levels of a wheel alternate), or out of the order of
 * time. */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "port/linux/live_block.h"

enum { MOST = 256, WHEELS = 8 };

struct check {
  uint64_t last_ns;
  uint32_t level[WHEELS]; /* 2: not known */
  unsigned long long wrong;
};

static void forget_levels(struct check* check) {
  int i;
  for (i = 0; i < WHEELS; ++i) check->level[i] = 2;
}

static void take(struct check* check, const struct crankloop_live_edge* edge) {
  if (edge->due_ns < check->last_ns || edge->wheel >= WHEELS || edge->level > 1) {
    ++check->wrong;
  } else {
    if (edge->level == check->level[edge->wheel]) ++check->wrong;
    check->level[edge->wheel] = edge->level;
  }
  check->last_ns = edge->due_ns;
}

/* Edges lost count as that; what came after them is anew. */
static void follow(const struct crankloop_live_block* block, struct crankloop_live_edge_reader* reader, double seconds,
                   long pause_ms, struct check* check) {
  const struct timespec pause = {pause_ms / 1000, pause_ms % 1000 * 1000000};
  struct crankloop_live_edge edges[MOST];
  double waited_s = 0;
  int last = 0;
  while (!last) {
    size_t count, i;
    last = __atomic_load_n(&block->state, __ATOMIC_ACQUIRE) != CRANKLOOP_LIVE_RUNNING || waited_s >= seconds;
    do {
      const uint64_t lost = reader->lost;
      count = crankloop_live_edges_read(reader, edges, MOST);
      if (reader->lost != lost) forget_levels(check);
      for (i = 0; i < count; ++i) take(check, edges + i);
    } while (count > 0);
    if (last) break;
    nanosleep(&pause, NULL);
    waited_s += (double)pause_ms / 1000;
  }
}

int main(int count, char** words) {
  struct crankloop_live_edge_reader reader;
  struct check check;
  struct stat found;
  const char* refusal;
  uint64_t begin;
  void* map;
  const int file = count == 4 ? open(words[1], O_RDONLY) : -1;
  if (file < 0 || fstat(file, &found) != 0) return puts("no block"), 1;
  map = mmap(NULL, (size_t)found.st_size, PROT_READ, MAP_SHARED, file, 0); /* a reader need not be able to write */
  if (map == MAP_FAILED) return puts("no block"), 1;
  refusal = crankloop_live_refusal(map, (size_t)found.st_size);
  if (refusal != NULL) return printf("%s: %s\n", words[1], refusal), 1;
  if (!crankloop_live_edges_begin(map, &reader)) return puts("no trigger wheel"), 1;
  begin = reader.next;
  check.last_ns = 0;
  check.wrong = 0;
  forget_levels(&check);
  follow(map, &reader, atof(words[2]), atol(words[3]), &check);
  printf("begin = %llu\nread = %llu\nlost = %llu\nwritten = %llu\nwrong = %llu\n", (unsigned long long)begin,
         (unsigned long long)reader.read, (unsigned long long)reader.lost, (unsigned long long)reader.next,
         check.wrong);
  return 0;
}

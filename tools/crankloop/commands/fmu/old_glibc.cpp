// Symbols that an FMU's shared object would need from glibc after 2.17 only because the compiler's static libraries
// were built with a later one. They are defined here, so that the object loads on older systems too.
// tests/fmi/object.sh has the list of what it may ask for.
#ifdef __linux__
#include <cerrno>
#include <cstddef>
#include <cstdint>

#include <dlfcn.h>
#include <link.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__GLIBC__) && (defined(__x86_64__) || defined(__aarch64__))
extern "C" {

// glibc 2.32: whether the C++ library may count references without locks. Never.
extern char __libc_single_threaded;
char __libc_single_threaded = 0;

// glibc 2.33: before, it was a macro of its header. On these processors the kernel's struct is the library's.
int fstat(int file, struct stat* found) noexcept { return static_cast<int>(::syscall(SYS_fstat, file, found)); }

// glibc 2.34: before, it was in a separate library, like all thread functions but mutexes.
int pthread_once(pthread_once_t* once, void (*work)()) {
  static pthread_mutex_t mutex = PTHREAD_RECURSIVE_MUTEX_INITIALIZER_NP;  // work may come by another
  pthread_mutex_lock(&mutex);
  if (*once == PTHREAD_ONCE_INIT) work();
  *once = PTHREAD_ONCE_INIT + 1;
  pthread_mutex_unlock(&mutex);
  return 0;
}
// Referenced, never called: its presence tells the C++ library that there may be threads.
int __pthread_key_create(pthread_key_t*, void (*)(void*)) { return EAGAIN; }

#ifdef DLFO_STRUCT_HAS_EH_DBASE
// glibc 2.35: finds the exception tables of a code address. This is the way of earlier compilers.
int _dl_find_object(void* code, dl_find_object* found) noexcept {
  struct Wanted {
    std::uintptr_t code;
    dl_find_object* found;
  } sought{reinterpret_cast<std::uintptr_t>(code), found};
  const auto look = [](dl_phdr_info* object, std::size_t, void* data) {
    const auto& wanted = *static_cast<const Wanted*>(data);
    const ElfW(Phdr)* tables = nullptr;
    bool inside = false;
    for (const ElfW(Phdr)* p = object->dlpi_phdr; p != object->dlpi_phdr + object->dlpi_phnum; ++p) {
      if (p->p_type == PT_GNU_EH_FRAME) tables = p;
      if (p->p_type == PT_LOAD && wanted.code - (object->dlpi_addr + p->p_vaddr) < p->p_memsz) inside = true;
    }
    if (!inside || tables == nullptr) return 0;
    *wanted.found = {};
    wanted.found->dlfo_eh_frame = reinterpret_cast<void*>(object->dlpi_addr + tables->p_vaddr);
    return 1;
  };
  return dl_iterate_phdr(look, &sought) == 1 ? 0 : -1;
}
#endif

}  // extern "C"
#endif
#endif

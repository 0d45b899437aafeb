#include "shared_block.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

namespace crankloop::port {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) { throw SharedBlockError(path + ": " + why); }
[[noreturn]] void refuse(const std::string& path, const char* what, int error) {
  refuse(path, std::string(what) + ": " + std::strerror(error));
}

/// A file's descriptor until someone takes it over.
class File {
 public:
  explicit File(int descriptor) noexcept : descriptor_{descriptor} {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] int release() noexcept { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
};

bool is_block_sized(int file) {
  struct stat found {};
  return ::fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_size == static_cast<off_t>(kLiveBlockBytes);
}

/// Removes a block that no process runs on any more.
void remove_left_over(const std::string& path) {
  const File old(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (old.descriptor() < 0) refuse(path, "exists and cannot be opened", errno);
  std::uint32_t head[2] = {0, 0};
  if (!is_block_sized(old.descriptor()) || ::pread(old.descriptor(), head, sizeof head, 0) != sizeof head || head[0] != kLiveMagic ||
      head[1] != kLiveVersion) {
    refuse(path, "exists and is no block of this version of crankloop");
  }
  if (::flock(old.descriptor(), LOCK_EX | LOCK_NB) != 0) refuse(path, "another process runs on this block");
  if (::unlink(path.c_str()) != 0) refuse(path, "cannot be removed", errno);
}

int create_file(const std::string& path) {
  constexpr int kFlags = O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC;
  constexpr mode_t kMode = 0660;
  File file(::open(path.c_str(), kFlags, kMode));
  if (file.descriptor() < 0 && errno == EEXIST) {
    remove_left_over(path);
    return create_file(path);
  }
  if (file.descriptor() < 0) refuse(path, "cannot be created", errno);
  ::flock(file.descriptor(), LOCK_EX | LOCK_NB);  // until this process ends, however it does: tells a running block from a left-over one
  // Room now, or a full disk would stop the loop by a signal later.
  if (const int error = ::posix_fallocate(file.descriptor(), 0, static_cast<off_t>(kLiveBlockBytes)); error != 0) {
    ::unlink(path.c_str());
    refuse(path, "has no room", error);
  }
  return file.release();
}

}  // namespace

SharedBlock::SharedBlock(std::string path, int file, bool creator) : path_{std::move(path)}, file_{file}, creator_{creator} {
  void* memory = ::mmap(nullptr, kLiveBlockBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) {
    const int error = errno;
    ::close(file_);
    if (creator_) ::unlink(path_.c_str());
    refuse(path_, "cannot be mapped", error);
  }
  block_ = creator_ ? new (memory) LiveBlock : std::launder(static_cast<LiveBlock*>(memory));
}

SharedBlock SharedBlock::create(const std::string& path, double tick_s, std::uint32_t cylinders) {
  SharedBlock block(path, create_file(path), true);
  block->version = kLiveVersion;
  block->size_bytes = kLiveBlockBytes;
  block->tick_s = tick_s;
  block->cylinders = cylinders;
  block->magic.store(kLiveMagic, std::memory_order_release);
  return block;
}

SharedBlock SharedBlock::open(const std::string& path) {
  File file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (file.descriptor() < 0) refuse(path, "cannot be opened", errno);
  if (!is_block_sized(file.descriptor())) refuse(path, "is no block of this version of crankloop");
  SharedBlock block(path, file.release(), false);
  const std::uint32_t magic = block->magic.load(std::memory_order_acquire);
  if (magic == 0) refuse(path, "is not ready yet");
  if (magic != kLiveMagic || block->version != kLiveVersion || block->size_bytes != kLiveBlockBytes) {
    refuse(path, "is no block of this version of crankloop");
  }
  return block;
}

SharedBlock::SharedBlock(SharedBlock&& other) noexcept
    : path_{std::move(other.path_)},
      file_{std::exchange(other.file_, -1)},
      creator_{other.creator_},
      block_{std::exchange(other.block_, nullptr)} {}

SharedBlock::~SharedBlock() {
  if (block_ == nullptr) return;
  if (creator_) {
    block_->state.store(LiveState::ended, std::memory_order_release);
    struct stat mine {};
    struct stat there {};
    const bool still_mine = ::fstat(file_, &mine) == 0 && ::lstat(path_.c_str(), &there) == 0 && mine.st_dev == there.st_dev &&
                            mine.st_ino == there.st_ino;
    if (still_mine) ::unlink(path_.c_str());
  }
  ::munmap(block_, kLiveBlockBytes);
  ::close(file_);
}

}  // namespace crankloop::port

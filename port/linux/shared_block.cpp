#include "shared_block.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
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

// ---- a block that is taken away -------------------------------------------------------------------------------------

constexpr std::size_t kMaxBlocks = 8;  // of one process, at a time
std::array<std::atomic<void*>, kMaxBlocks> mapped_blocks{};

/// Puts a page of zeros in the place of a block's that is gone; the access is then made again. mmap is no more than its
/// system call.
extern "C" void replace_lost_block(int signal_number, siginfo_t* information, void*) {
  const auto* touched = static_cast<const unsigned char*>(information->si_addr);
  for (const std::atomic<void*>& mapped : mapped_blocks) {
    void* block = mapped.load();
    const auto* first = static_cast<const unsigned char*>(block);
    if (block == nullptr || touched < first || touched >= first + kLiveBlockBytes) continue;
    constexpr int kInPlace = MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED;
    if (::mmap(block, kLiveBlockBytes, PROT_READ | PROT_WRITE, kInPlace, -1, 0) == block) return;
  }
  std::signal(signal_number, SIG_DFL);  // the access is made again, and ends the process
}

void survive_loss_of(void* block) {
  for (std::atomic<void*>& mapped : mapped_blocks) {
    void* none = nullptr;
    if (!mapped.compare_exchange_strong(none, block)) continue;
    struct sigaction replace {};
    replace.sa_sigaction = replace_lost_block;
    replace.sa_flags = SA_SIGINFO;
    ::sigaction(SIGBUS, &replace, nullptr);
    return;
  }
}

void forget(void* block) {
  for (std::atomic<void*>& mapped : mapped_blocks) {
    void* expected = block;
    if (mapped.compare_exchange_strong(expected, nullptr)) return;
  }
}

// ---- files ----------------------------------------------------------------------------------------------------------

bool is_block_sized(int file) {
  struct stat found {};
  return ::fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_size == static_cast<off_t>(kLiveBlockBytes);
}

/// Whether an open file is what `path` leads to.
bool is_at(int file, const std::string& path) {
  struct stat mine {};
  struct stat there {};
  return ::fstat(file, &mine) == 0 && ::lstat(path.c_str(), &there) == 0 && mine.st_dev == there.st_dev &&
         mine.st_ino == there.st_ino;
}

/// A block of this version, or what there is of one whose maker died over it, or that was truncated: the words of its
/// head are right, or 0, or not there.
bool was_block(int file) {
  struct stat found {};
  if (::fstat(file, &found) != 0 || !S_ISREG(found.st_mode) || found.st_size > static_cast<off_t>(kLiveBlockBytes))
    return false;
  std::array<std::uint32_t, 3> head{};
  if (::pread(file, head.data(), sizeof head, 0) < 0) return false;
  constexpr std::array<std::uint32_t, 3> kHead{kLiveMagic, kLiveVersion, std::uint32_t{kLiveBlockBytes}};
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (head[i] != 0 && head[i] != kHead[i]) return false;
  }
  return true;
}

/// Removes a block that no process runs on any more. Only who has its lock may, so nobody removes what another has put
/// there meanwhile.
void remove_left_over(const std::string& path) {
  const File old(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (old.descriptor() < 0 && errno == ENOENT) return;  // its owner has ended, or another has removed it
  if (old.descriptor() < 0) refuse(path, "exists and cannot be opened", errno);
  if (!was_block(old.descriptor())) refuse(path, "exists and is no block of this version of crankloop");
  if (::flock(old.descriptor(), LOCK_EX | LOCK_NB) != 0) refuse(path, "another process runs on this block");
  if (is_at(old.descriptor(), path) && ::unlink(path.c_str()) != 0) refuse(path, "cannot be removed", errno);
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
  // Locked until this process ends, however it does: that distinguishes a running block from a stale one. In the moment
  // before, another process may have taken it for one that its maker died over.
  const bool taken = ::flock(file.descriptor(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (taken || !is_at(file.descriptor(), path)) return create_file(path);
  // Room now, or a full disk would stop the loop by a signal later.
  if (const int error = ::posix_fallocate(file.descriptor(), 0, static_cast<off_t>(kLiveBlockBytes)); error != 0) {
    ::unlink(path.c_str());
    refuse(path, "has no room", error);
  }
  return file.release();
}

}  // namespace

SharedBlock::SharedBlock(std::string path, int file, bool creator)
    : path_{std::move(path)}, file_{file}, creator_{creator} {
  void* memory = ::mmap(nullptr, kLiveBlockBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) {
    const int error = errno;
    ::close(file_);
    if (creator_) ::unlink(path_.c_str());
    refuse(path_, "cannot be mapped", error);
  }
  survive_loss_of(memory);
  block_ = creator_ ? new (memory) LiveBlock : std::launder(static_cast<LiveBlock*>(memory));
}

SharedBlock SharedBlock::create(const std::string& path, double tick_s, std::uint32_t cylinders, bool breathes) {
  SharedBlock block(path, create_file(path), true);
  block->version = kLiveVersion;
  block->size_bytes = kLiveBlockBytes;
  block->tick_s = tick_s;
  block->cylinders = cylinders;
  block->breathes = breathes ? 1 : 0;
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

bool SharedBlock::is_whole() const noexcept { return has_magic() && is_block_sized(file_); }

SharedBlock::SharedBlock(SharedBlock&& other) noexcept
    : path_{std::move(other.path_)},
      file_{std::exchange(other.file_, -1)},
      creator_{other.creator_},
      block_{std::exchange(other.block_, nullptr)} {}

SharedBlock::~SharedBlock() {
  if (block_ == nullptr) return;
  if (creator_) {
    block_->state.store(LiveState::ended, std::memory_order_release);
    if (is_at(file_, path_)) ::unlink(path_.c_str());
  }
  forget(block_);
  ::munmap(block_, kLiveBlockBytes);
  ::close(file_);
}

}  // namespace crankloop::port

#include "shared_block.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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
  throw SharedBlockSystemError(path + ": " + what + ": " + std::strerror(error));
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

struct MappedBlock {
  std::atomic<void*> at{nullptr};
  std::atomic<std::size_t> bytes{0};  ///< 0 until it is known: then no address is within
};
constexpr std::size_t kMaxBlocks = 8;  // of one process, at a time
std::array<MappedBlock, kMaxBlocks> mapped_blocks{};

/// Puts zeros in the place of a block of which a page is gone; the access is then made again. mmap is no more than its
/// system call.
extern "C" void replace_lost_block(int signal_number, siginfo_t* information, void*) {
  const auto* touched = static_cast<const unsigned char*>(information->si_addr);
  for (const MappedBlock& mapped : mapped_blocks) {
    void* block = mapped.at.load();
    const std::size_t bytes = mapped.bytes.load();
    const auto* first = static_cast<const unsigned char*>(block);
    if (block == nullptr || touched < first || touched >= first + bytes) continue;
    constexpr int kInPlace = MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED;
    if (::mmap(block, bytes, PROT_READ | PROT_WRITE, kInPlace, -1, 0) == block) return;
  }
  std::signal(signal_number, SIG_DFL);  // the access is made again, and ends the process
}

void survive_loss_of(void* block, std::size_t bytes) {
  const std::size_t page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  for (MappedBlock& mapped : mapped_blocks) {
    void* none = nullptr;
    if (!mapped.at.compare_exchange_strong(none, block)) continue;
    mapped.bytes = (bytes + page - 1) / page * page;
    struct sigaction replace {};
    replace.sa_sigaction = replace_lost_block;
    replace.sa_flags = SA_SIGINFO;
    ::sigaction(SIGBUS, &replace, nullptr);
    return;
  }
}

void forget(void* block) {
  for (MappedBlock& mapped : mapped_blocks) {
    if (mapped.at.load() != block) continue;
    mapped.bytes = 0;
    mapped.at = nullptr;
    return;
  }
}

// ---- sections -------------------------------------------------------------------------------------------------------

using Section = crankloop_live_section;

constexpr std::uint32_t up_to_64(std::uint32_t bytes) noexcept { return (bytes + 63) / 64 * 64; }

/// Bytes before a section's entries.
constexpr std::uint32_t head_bytes(std::uint32_t kind) noexcept {
  if (kind == CRANKLOOP_LIVE_EDGES) return sizeof(crankloop_live_edges);
  return kind == CRANKLOOP_LIVE_SIGNALS || kind == CRANKLOOP_LIVE_INPUTS ? sizeof(crankloop_live_numbers) : 0;
}

/// Where each section of such a block is, and its size. Sections without entries are left out.
std::vector<Section> plan(const LiveContents& contents, std::uint32_t& block_bytes) {
  const auto count = [](const std::vector<std::string>& names) { return static_cast<std::uint32_t>(names.size()); };
  constexpr std::uint32_t kName = CRANKLOOP_LIVE_NAME_BYTES;
  constexpr std::uint32_t kNumber = sizeof(double);
  std::vector<Section> sections = {
      {CRANKLOOP_LIVE_SIGNAL_NAMES, 0, count(contents.signals), kName},
      {CRANKLOOP_LIVE_SIGNALS, 0, count(contents.signals), kNumber},
      {CRANKLOOP_LIVE_INPUT_NAMES, 0, count(contents.inputs), kName},
      {CRANKLOOP_LIVE_INPUTS, 0, count(contents.inputs), kNumber},
      {CRANKLOOP_LIVE_WHEEL_NAMES, 0, count(contents.wheels), kName},
      {CRANKLOOP_LIVE_EDGES, 0, contents.ring_edges, sizeof(crankloop_live_edge)},
  };
  sections.erase(std::remove_if(sections.begin(), sections.end(), [](const Section& s) { return s.count == 0; }),
                 sections.end());
  std::uint32_t end = up_to_64(std::uint32_t{kLiveFixedBytes} +
                               static_cast<std::uint32_t>(sections.size()) * std::uint32_t{sizeof(Section)});
  for (Section& section : sections) {
    section.offset = end;
    end = up_to_64(end + head_bytes(section.kind) + section.count * section.entry_bytes);
  }
  block_bytes = end;
  return sections;
}

void write_names(void* to, const std::vector<std::string>& names) {
  auto* text = static_cast<char*>(to);
  for (const std::string& name : names) {
    name.copy(text, CRANKLOOP_LIVE_NAME_BYTES - 1);
    text += CRANKLOOP_LIVE_NAME_BYTES;
  }
}

// ---- files ----------------------------------------------------------------------------------------------------------

constexpr std::size_t kNoRegularFile = ~std::size_t{0};

std::size_t size_of(int file) {
  struct stat found {};
  if (::fstat(file, &found) != 0 || !S_ISREG(found.st_mode)) return kNoRegularFile;
  return static_cast<std::size_t>(found.st_size);
}

/// The first words of a block: magic, version, size. What the file does not have is 0.
struct Head {
  std::uint32_t magic = 0;
  std::uint32_t version = 0;
  std::uint32_t size_bytes = 0;
};

bool read_head(int file, Head& head) { return ::pread(file, &head, sizeof head, 0) >= 0; }

std::string of_another_version(const Head& head) {
  return "a block of version " + std::to_string(head.version) + " of crankloop live; this one's is " +
         std::to_string(kLiveVersion);
}

/// Whether an open file is what `path` leads to.
bool is_at(int file, const std::string& path) {
  struct stat mine {};
  struct stat there {};
  return ::fstat(file, &mine) == 0 && ::lstat(path.c_str(), &there) == 0 && mine.st_dev == there.st_dev &&
         mine.st_ino == there.st_ino;
}

/// A block of this version, or what there is of one whose maker died over it, or that was truncated: the words of its
/// head are right, or 0, or not there. A file larger than the fixed part has to have some of them.
bool was_block(int file, const Head& head) {
  const std::size_t size = size_of(file);
  if (size == kNoRegularFile || (head.magic != 0 && head.magic != kLiveMagic)) return false;
  if (size <= kLiveFixedBytes) return head.version == 0 || head.version == kLiveVersion;
  return head.version == kLiveVersion && size <= head.size_bytes;
}

/// Removes a block that no process runs on any more. Only who has its lock may, so nobody removes what another has put
/// there meanwhile.
void remove_left_over(const std::string& path) {
  const File old(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (old.descriptor() < 0 && errno == ENOENT) return;  // its owner has ended, or another has removed it
  if (old.descriptor() < 0) refuse(path, "exists and cannot be opened", errno);
  Head head;
  if (!read_head(old.descriptor(), head)) head.magic = ~kLiveMagic;
  if (head.magic == kLiveMagic && head.version != kLiveVersion)
    refuse(path, "exists and is " + of_another_version(head));
  if (!was_block(old.descriptor(), head)) refuse(path, "exists and is no block of crankloop live");
  if (::flock(old.descriptor(), LOCK_EX | LOCK_NB) != 0) refuse(path, "another process runs on this block");
  if (is_at(old.descriptor(), path) && ::unlink(path.c_str()) != 0) refuse(path, "cannot be removed", errno);
}

/// A file that is there and locked becomes a block: all zeros but for version and size.
void make_block(int file, const std::string& path, std::uint32_t bytes) {
  // Who dies over it leaves a file that is known as a block's.
  const Head head{0, kLiveVersion, bytes};
  int error = ::pwrite(file, &head, sizeof head, 0) == ssize_t{sizeof head} ? 0 : errno;
  // Room now, or a full disk would stop the loop by a signal later.
  if (error == 0) error = ::posix_fallocate(file, 0, static_cast<off_t>(bytes));
  if (error == 0) return;
  ::unlink(path.c_str());
  refuse(path, "has no room", error);
}

/// Tries again as often as another process takes or removes the file meanwhile.
int create_file(const std::string& path, std::uint32_t bytes) {
  constexpr int kFlags = O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC;
  constexpr mode_t kMode = 0660;
  for (;;) {
    File file(::open(path.c_str(), kFlags, kMode));
    if (file.descriptor() < 0) {
      if (errno != EEXIST) refuse(path, "cannot be created", errno);
      remove_left_over(path);
      continue;
    }
    // Locked until this process ends, however it does: that distinguishes a running block from a stale one. In the
    // moment before, another process may have taken it for one that its maker died over.
    const bool taken = ::flock(file.descriptor(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (taken || !is_at(file.descriptor(), path)) continue;
    make_block(file.descriptor(), path, bytes);
    return file.release();
  }
}

}  // namespace

SharedBlock::SharedBlock(std::string path, int file, std::size_t bytes, bool creator)
    : path_{std::move(path)}, file_{file}, bytes_{bytes}, creator_{creator} {
  void* memory = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) {
    const int error = errno;
    ::close(file_);
    if (creator_) ::unlink(path_.c_str());
    refuse(path_, "cannot be mapped", error);
  }
  survive_loss_of(memory, bytes_);
  if (creator_) std::memset(memory, 0, bytes_);  // and its pages are there before the loop begins
  block_ = creator_ ? new (memory) LiveBlock : std::launder(static_cast<LiveBlock*>(memory));
}

SharedBlock SharedBlock::create(const std::string& path, const LiveContents& contents) {
  std::uint32_t bytes = 0;
  std::vector<Section> sections = plan(contents, bytes);
  SharedBlock block(path, create_file(path, bytes), bytes, true);
  block.sections_ = std::move(sections);
  block->version = kLiveVersion;
  block->size_bytes = bytes;
  block->tick_s = contents.tick_s;
  block->cylinders = contents.cylinders;
  block->breathes = contents.breathes ? 1 : 0;
  block->section_count = static_cast<std::uint32_t>(block.sections_.size());
  block->section_list = kLiveFixedBytes;
  auto* list = reinterpret_cast<Section*>(block.block_ + 1);
  for (const Section& section : block.sections_) {
    *list++ = section;
    if (section.kind == CRANKLOOP_LIVE_SIGNAL_NAMES) write_names(block.at(section), contents.signals);
    if (section.kind == CRANKLOOP_LIVE_INPUT_NAMES) write_names(block.at(section), contents.inputs);
    if (section.kind == CRANKLOOP_LIVE_WHEEL_NAMES) write_names(block.at(section), contents.wheels);
  }
  block->magic.store(kLiveMagic, std::memory_order_release);
  return block;
}

SharedBlock SharedBlock::open(const std::string& path) {
  File file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (file.descriptor() < 0) refuse(path, "cannot be opened", errno);
  Head head;
  const std::size_t bytes = size_of(file.descriptor());
  if (bytes == kNoRegularFile || !read_head(file.descriptor(), head)) refuse(path, "is no block of crankloop live");
  if (head.magic == kLiveMagic && head.version != kLiveVersion) refuse(path, "is " + of_another_version(head));
  if (bytes < kLiveFixedBytes || bytes > std::size_t{1} << 30)
    refuse(path, bytes == 0 || head.version == kLiveVersion ? "is not ready yet" : "is no block of crankloop live");
  SharedBlock block(path, file.release(), bytes, false);
  if (const char* why = crankloop_live_refusal(block.data(), bytes); why != nullptr) refuse(path, why);
  const auto* list = static_cast<const char*>(block.data()) + block->section_list;
  block.sections_.resize(std::min<std::size_t>(block->section_count, 64));
  std::memcpy(block.sections_.data(), list, block.sections_.size() * sizeof(Section));
  // Whoever may write to the file may have changed the list since it was checked.
  const auto leads_out = [bytes](const Section& s) {
    return s.offset % 64 != 0 ||
           std::uint64_t{s.offset} + head_bytes(s.kind) + std::uint64_t{s.count} * s.entry_bytes > bytes;
  };
  block.sections_.erase(std::remove_if(block.sections_.begin(), block.sections_.end(), leads_out),
                        block.sections_.end());
  return block;
}

bool SharedBlock::is_whole() const noexcept { return has_magic() && size_of(file_) == bytes_; }

void* SharedBlock::at(const Section& section) const noexcept {
  return reinterpret_cast<unsigned char*>(block_) + section.offset;
}

const SharedBlock::Section* SharedBlock::find(std::uint32_t kind) const noexcept {
  for (const Section& section : sections_) {
    if (section.kind == kind) return &section;
  }
  return nullptr;
}

LockedNumbers SharedBlock::numbers(std::uint32_t kind) const noexcept {
  const Section* section = find(kind);
  if (section == nullptr || section->entry_bytes != sizeof(double)) return {};
  return {at(*section), std::min<std::size_t>(section->count, kMaxLiveNumbers)};
}

EdgeRing SharedBlock::edges() const noexcept {
  const Section* section = find(CRANKLOOP_LIVE_EDGES);
  return section == nullptr ? EdgeRing{} : EdgeRing{at(*section), section->count};
}

SharedBlock::SharedBlock(SharedBlock&& other) noexcept
    : path_{std::move(other.path_)},
      file_{std::exchange(other.file_, -1)},
      bytes_{other.bytes_},
      creator_{other.creator_},
      block_{std::exchange(other.block_, nullptr)},
      sections_{std::move(other.sections_)} {}

SharedBlock::~SharedBlock() {
  if (block_ == nullptr) return;
  if (creator_) {
    block_->state.store(LiveState::ended, std::memory_order_release);
    if (is_at(file_, path_)) ::unlink(path_.c_str());
  }
  forget(block_);
  ::munmap(block_, bytes_);
  ::close(file_);
}

}  // namespace crankloop::port

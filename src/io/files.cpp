#include "io/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <glob.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace trackbed {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path, std::size_t limit) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw InputError(fmt::format("{}: this is a folder, a file is needed", path.string()));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  std::string bytes;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    bytes.append(block, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > limit)
      throw InputError(fmt::format("{}: the file is larger than {} MB", path.string(), limit / 1000000));
  }
  if (in.bad()) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  return bytes;
}

namespace {

/// Whether it could be done; else errno tells why not.
bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Makes names in a folder last; some file systems cannot, and need not.
void sync_folder(const fs::path& folder) {
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes, Lasting lasting) {
  write_file(path, {bytes}, lasting);
}

void write_file(const fs::path& path, std::initializer_list<std::string_view> parts, Lasting lasting) {
  const fs::path draft = path.string() + fmt::format(".{}.part", ::getpid());
  const auto fail = [&](const char* what, int cause) {
    ::unlink(draft.c_str());
    throw RunError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(cause)));
  };
  const int file = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail("cannot be written", errno);
  for (const std::string_view part : parts) {
    if (write_all(file, part)) continue;
    const int cause = errno;
    ::close(file);
    fail("cannot be written", cause);
  }
  const bool is_safe = lasting == Lasting::in_memory || ::fsync(file) == 0;
  if (::close(file) != 0 || !is_safe) fail("cannot be written", errno);
  if (::rename(draft.c_str(), path.c_str()) != 0) fail("cannot be put in place", errno);
  if (lasting == Lasting::on_disk) sync_folder(path.parent_path());
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw RunError(fmt::format("{}: the folder cannot be made: {}", path.string(), error.message()));
}

bool is_pattern(const fs::path& path) {
  return path.string().find_first_of("*?[") != std::string::npos;
}

std::vector<fs::path> expand_pattern(const fs::path& pattern) {
  glob_t found{};
  const int result = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<fs::path> paths;
  if (result == 0) paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  // Bytes, not the alphabet of the user's language: the same order on every machine.
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return a.native() < b.native(); });
  return paths;
}

}  // namespace trackbed

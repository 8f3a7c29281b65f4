#include "lab/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "io/files.h"

namespace trackbed {
namespace fs = std::filesystem;
namespace {

std::uint64_t checksum(std::string_view bytes) {
  Hash hash;
  hash.add(bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash.add(word);
  }
  return hash.value();
}

/// Ascending by age: their numbers have as many digits.
std::vector<fs::path> files_in(const fs::path& folder) {
  return expand_pattern(folder / "[0-9]*.state");
}

}  // namespace

void write_checked(const fs::path& file, std::string_view bytes) {
  const std::uint64_t sum = checksum(bytes);
  write_file(file, {state_format, {reinterpret_cast<const char*>(&sum), sizeof sum}, bytes},
             Lasting::on_disk);
}

std::optional<std::string> read_checked(const fs::path& file) {
  std::string bytes;
  try {
    bytes = read_file(file);
  } catch (const InputError&) {
    return std::nullopt;
  }
  std::uint64_t sum = 0;
  const std::size_t begin = state_format.size() + sizeof sum;
  if (bytes.size() < begin || !bytes.starts_with(state_format)) return std::nullopt;
  std::memcpy(&sum, bytes.data() + state_format.size(), sizeof sum);
  if (sum != checksum(std::string_view(bytes).substr(begin))) return std::nullopt;
  bytes.erase(0, begin);
  return bytes;
}

Checkpoints::Checkpoints(fs::path folder, double every) : folder_(std::move(folder)), every_(every) {}

bool Checkpoints::is_due() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >= every_;
}

void Checkpoints::write(std::string_view bytes) {
  make_folder(folder_);
  std::vector<fs::path> old = files_in(folder_);
  const std::uint64_t number = old.empty() ? 1 : std::stoull(old.back().stem().string()) + 1;
  write_checked(folder_ / fmt::format("{:09}.state", number), bytes);
  constexpr std::size_t kept_of_old = 1;
  std::error_code ignored;  // a file too many does no harm
  for (std::size_t k = 0; k + kept_of_old < old.size(); ++k) fs::remove(old[k], ignored);
  last_ = std::chrono::steady_clock::now();
}

std::optional<std::string> Checkpoints::newest() const {
  const std::vector<fs::path> files = files_in(folder_);
  for (auto file = files.rbegin(); file != files.rend(); ++file)
    if (auto content = read_checked(*file)) return content;
  if (!files.empty())
    throw InputError(
        folder_.string() +
        ": no checkpoint here is whole and of this version of the program; leave out --resume to "
        "begin anew");
  return std::nullopt;
}

void Checkpoints::clear() {
  std::error_code ignored;  // they do no harm
  fs::remove_all(folder_, ignored);
}

}  // namespace trackbed

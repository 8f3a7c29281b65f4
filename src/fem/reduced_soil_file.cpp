#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "base/hash.h"
#include "fem/reduced_soil.h"

namespace trackbed::fem {

namespace {

/// To be raised whenever the same input gives other numbers.
constexpr std::uint64_t version = 3;

std::uint64_t hash_of(const SoilInput& in, const ReductionInput& reduction) {
  Hash h;
  h.add(version);
  for (const Elastic& solid : {in.ballast, in.subgrade})
    for (double value : {solid.young, solid.poisson, solid.density}) h.add(value);
  for (double value :
       {in.element_size, in.length, in.ballast_depth, in.subgrade_depth, in.half_width, in.crest,
        in.shoulder_slope, in.mass_damping, in.stiffness_damping, in.first_sleeper, in.sleeper_spacing,
        in.sleeper_width, in.sleeper_half_length, reduction.window, reduction.blow_frequency})
    h.add(value);
  for (Support s : {in.start, in.end, in.side, in.base}) h.add(s);
  h.add(in.element);
  h.add(in.whole_width);
  h.add(in.sleepers);
  h.add(reduction.krylov);
  h.add(reduction.krylov_at_free_end);
  return h.value();
}

/// Numbers as they lie in memory, with a hash of them all behind.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& file) : out_(file, std::ios::binary) {}
  void add(std::uint64_t word) { add_bytes(reinterpret_cast<const char*>(&word), sizeof word); }
  void add(const Eigen::MatrixXd& m) {
    add(static_cast<std::uint64_t>(m.rows()));
    add(static_cast<std::uint64_t>(m.cols()));
    for (double value : m.reshaped()) hash_.add(value);
    out_.write(reinterpret_cast<const char*>(m.data()),
               m.size() * static_cast<std::streamsize>(sizeof(double)));
  }
  bool finish() {
    add(hash_.value());
    out_.close();
    return static_cast<bool>(out_);
  }

 private:
  void add_bytes(const char* bytes, std::streamsize size) {
    std::uint64_t word;
    std::memcpy(&word, bytes, sizeof word);
    hash_.add(word);
    out_.write(bytes, size);
  }
  std::ofstream out_;
  Hash hash_;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : in_(file, std::ios::binary) {
    std::error_code none;
    left_ = std::filesystem::file_size(file, none);
    if (none) left_ = 0;
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    if (take(sizeof value)) in_.read(reinterpret_cast<char*>(&value), sizeof value);
    last_hash_ = hash_.value();
    hash_.add(value);
    return value;
  }
  Eigen::MatrixXd matrix() {
    const std::uint64_t rows = word(), columns = word();
    if (columns > 0 && rows > left_ / sizeof(double) / columns) good_ = false;
    if (!good_ || !take(rows * columns * sizeof(double))) return {};
    Eigen::MatrixXd m(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    in_.read(reinterpret_cast<char*>(m.data()), m.size() * static_cast<std::streamsize>(sizeof(double)));
    for (double value : m.reshaped()) hash_.add(value);
    return m;
  }
  /// Is the file whole?
  bool finish() {
    const std::uint64_t wanted = word();
    return good_ && in_ && left_ == 0 && wanted == last_hash_;
  }

 private:
  bool take(std::uint64_t bytes) {
    if (bytes > left_) good_ = false;
    if (good_) left_ -= bytes;
    return good_;
  }
  std::ifstream in_;
  std::uint64_t left_ = 0, last_hash_ = 0;
  bool good_ = true;
  Hash hash_;
};

bool read(const std::filesystem::path& file, std::uint64_t key, ReducedSoil& soil) {
  Reader in(file);
  if (in.word() != key) return false;
  soil.stiffness = in.matrix().reshaped();
  soil.damping = in.matrix();
  soil.nodes = in.matrix();
  soil.gravity = in.matrix().reshaped();
  return in.finish();
}

void write(const std::filesystem::path& file, std::uint64_t key, const ReducedSoil& soil) {
  std::filesystem::path beside = file;
  beside += fmt::format(".{}.new", getpid());
  Writer out(beside);
  out.add(key);
  out.add(Eigen::MatrixXd(soil.stiffness));
  out.add(soil.damping);
  out.add(soil.nodes);
  out.add(Eigen::MatrixXd(soil.gravity));
  std::error_code failed;
  if (out.finish()) std::filesystem::rename(beside, file, failed);
  if (failed || !std::filesystem::exists(file)) {
    std::filesystem::remove(beside, failed);
    throw RunError(fmt::format("the reduced ground cannot be kept in {}", file.string()));
  }
}

std::filesystem::path file_of(std::uint64_t key, const std::filesystem::path& folder) {
  return folder / fmt::format("soil-{:016x}", key);
}

}  // namespace

bool is_kept(const Soil& soil, const ReductionInput& input, const std::filesystem::path& folder) {
  std::error_code none;
  return std::filesystem::exists(file_of(hash_of(soil.input, input), folder), none);
}

ReducedSoil reduce(const Soil& soil, const ReductionInput& input, const std::filesystem::path& folder) {
  const std::uint64_t key = hash_of(soil.input, input);
  const std::filesystem::path file = file_of(key, folder);
  ReducedSoil reduced;
  if (read(file, key, reduced)) return reduced;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);  // what went wrong is told on writing
  reduced = reduce(soil, input);
  write(file, key, reduced);
  return reduced;
}

}  // namespace trackbed::fem

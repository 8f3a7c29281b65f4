#include "lab/kept_bed.h"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

#include <iterator>
#include <sstream>
#include <string>

#include "base/error.h"
#include "io/files.h"

namespace trackbed {
namespace {

// The file is made of words. Each line begins with what it tells:
//   template NAME volume inertia(3) n, and on n lines x y z r; all for scale 1
//   stone template scale place(3) orientation(w x y z) material
//   body NAME place(3) orientation(4) applied force(3)
//   end

std::string words(const Vec3& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

std::string words(const Pose& pose) {
  const Quat& q = pose.orientation;
  return fmt::format("{} {} {} {} {}", words(pose.position), q.w(), q.x(), q.y(), q.z());
}

/// Takes the words of a kept bed one after the other.
class Words {
 public:
  explicit Words(const std::filesystem::path& file) : file_(file), text_(read_file(file)) {}

  /// The next word; empty at the end.
  std::string word() {
    std::string next;
    text_ >> next;
    return next;
  }
  double number() {
    double value = 0;
    if (!(text_ >> value)) fail();
    return value;
  }
  int index(std::size_t below) {
    const double value = number();
    if (!(value >= 0 && value < static_cast<double>(below))) fail();
    return static_cast<int>(value);
  }
  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Pose pose() {
    const Vec3 place = vector();
    const double w = number(), x = number(), y = number(), z = number();
    return {place, Quat(w, x, y, z)};
  }
  [[noreturn]] void fail() const {
    throw InputError(file_.string() +
                     ": this is no bed that was kept by this program, or a part of one; "
                     "delete it and it is made anew");
  }

 private:
  std::filesystem::path file_;
  std::istringstream text_;
};

ClumpTemplate read_template(Words& in) {
  const std::string name = in.word();
  const double volume = in.number();
  const Vec3 inertia = in.vector();
  const int n = in.index(100'000'000);
  std::vector<Pebble> pebbles;
  for (int k = 0; k < n; ++k) {
    const Vec3 centre = in.vector();
    pebbles.push_back({centre, in.number()});
  }
  return make_clump_template(name, std::move(pebbles), volume, inertia);
}

void read_stone(Words& in, Simulation& sim) {
  const int shape = in.index(sim.model.templates.size());
  const double scale = in.number();
  const Pose pose = in.pose();
  add_clump(sim.model, sim.state, shape, scale, in.index(sim.model.materials.size()), pose);
}

void read_body(Words& in, Simulation& sim) {
  const int wall = sim.find_wall(in.word());
  if (wall < 0) in.fail();
  const auto w = static_cast<std::size_t>(wall);
  WallState& body = sim.state.walls[w];
  body.pose = sim.wall_reference[w] = in.pose();
  body.applied_force = in.vector();
  body.present = true;
}

}  // namespace

void write_kept_bed(const Simulation& sim, const std::filesystem::path& file) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const ClumpTemplate& t : sim.model.templates) {
    fmt::format_to(out, "template {} {} {} {}\n", t.name, t.volume, words(t.inertia), t.pebbles.size());
    for (const Pebble& p : t.pebbles) fmt::format_to(out, "{} {}\n", words(p.centre), p.radius);
  }
  const Clumps& c = sim.state.clumps;
  std::vector<std::size_t> by_id(c.id.size());
  std::iota(by_id.begin(), by_id.end(), std::size_t{0});
  std::ranges::sort(by_id, {}, [&](std::size_t k) { return c.id[k]; });
  for (const std::size_t k : by_id)
    fmt::format_to(out, "stone {} {} {} {}\n", c.shape[k], c.scale[k],
                   words(Pose{c.position[k], c.orientation[k]}), c.material[k]);
  for (std::size_t w = 0; w < sim.state.walls.size(); ++w) {
    const WallState& wall = sim.state.walls[w];
    if (sim.model.walls[w].body && wall.present)
      fmt::format_to(out, "body {} {} {}\n", sim.model.walls[w].shape.name, words(wall.pose),
                     words(wall.applied_force));
  }
  text += "end\n";
  write_file(file, text);
}

void read_kept_bed(const std::filesystem::path& file, Simulation& sim) {
  Words in(file);
  sim.model.templates.clear();
  sim.state.clumps = {};
  for (std::string what = in.word(); what != "end"; what = in.word()) {
    if (what == "template")
      sim.model.templates.push_back(read_template(in));
    else if (what == "stone")
      read_stone(in, sim);
    else if (what == "body")
      read_body(in, sim);
    else
      in.fail();
  }
}

}  // namespace trackbed

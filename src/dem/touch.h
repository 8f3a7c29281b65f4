// The touching contacts of a block of pairs, and the response of four of them at a time.
#pragma once

#include <vector>

#include "base/lanes.h"
#include "dem/laws/table.h"

namespace trackbed {

/// What the contacts of one pair of bodies have in common: the motion of body 2 against body 1 as if the two
/// were one at the centre of mass of body 1.
struct PairFrame {
  Row velocity;   // of 2 - of 1 - spin of 2 x shift [m/s], and the reduced mass [kg]
  Row spin;       // of 2 - of 1 [rad/s]
  Row mean_spin;  // [rad/s]
  Row shift;      // from the centre of mass of body 1 to that of 2, or the wall's origin [m]
  const ContactProperties* properties;
};

/// A contact that touches in this step, and its response.
struct Touch {
  Row between;  // of two pebbles: from centre to centre, and the reach; at a wall: normal and overlap
  Row centre;   // of the pebble of body 1 from its centre of mass [m], and its radius [m]
  int frame;    // of its pair
  ContactMemory* memory;  //
  Row force;              // on body 2 [N], and the friction loss [J]
  Row moment;             // on body 2 about the centre of mass of body 1 [N m], and the rolling loss [J]
  double dashpot;         // loss [J]
};

/// Sum of the responses of a pair's contacts.
struct TouchSum {
  Row force = 0.0, moment = 0.0;
  double dashpot = 0;

  void operator+=(const Touch& t) {
    force += t.force;
    moment += t.moment;
    dashpot += t.dashpot;
  }
};

/// A growing list that gives its elements uninitialized and keeps its memory.
template <class T>
class Pile {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t k) { return values_[k]; }
  const T& operator[](std::size_t k) const { return values_[k]; }
  const T& back() const { return values_[size_ - 1]; }
  /// Makes room for `more` elements that add() then gives.
  void reserve(std::size_t more) {
    if (size_ + more > values_.size()) values_.resize(2 * (size_ + more));
  }
  T& add() { return values_[size_++]; }
  /// Takes the last one back, or not.
  void drop(bool last) { size_ -= last ? 1 : 0; }

 private:
  std::vector<T> values_;
  std::size_t size_ = 0;
};

/// Per-thread memory of one block's contacts, kept so that a step allocates nothing.
struct Touches {
  Pile<PairFrame> frames;
  Pile<Touch> touches;
  std::vector<int> left, later;

  void clear() {
    frames.clear();
    touches.clear();
  }
};

/// Where the normals of touches come from.
enum class TouchKind { between_pebbles, at_wall };

namespace detail {

struct Four {
  Touch* touch[Lanes::size];
};

template <class Get>
void gather(const Four& f, const Get& get, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  a = get(*f.touch[0]);
  b = get(*f.touch[1]);
  c = get(*f.touch[2]);
  d = get(*f.touch[3]);
  transpose(a, b, c, d);
}

template <class Get>
Vec3Of<Lanes> gather(const Four& f, const Get& get, Lanes& fourth) {
  Vec3Of<Lanes> v;
  gather(f, get, v.x(), v.y(), v.z(), fourth);
  return v;
}

template <class Put>
void scatter(const Four& f, const Put& put, const Vec3Of<Lanes>& v, Lanes fourth) {
  Lanes a = v.x(), b = v.y(), c = v.z(), d = fourth;
  transpose(a, b, c, d);
  put(*f.touch[0], a);
  put(*f.touch[1], b);
  put(*f.touch[2], c);
  put(*f.touch[3], d);
}

template <class Law, TouchKind touch_kind>
void respond(const Four& f, const Pile<PairFrame>& frames, const ContactProperties& p, double dt) {
  const auto frame = [&](const Touch& t) -> const PairFrame& {
    return frames[static_cast<std::size_t>(t.frame)];
  };
  Lanes reach, radius_1, unused;
  ContactKinematicsOf<Lanes> k;
  k.dt = dt;
  k.normal = gather(
      f, [](const Touch& t) { return t.between; }, reach);
  const Vec3Of<Lanes> centre = gather(
      f, [](const Touch& t) { return t.centre; }, radius_1);
  if constexpr (touch_kind == TouchKind::between_pebbles) {
    const Lanes distance = sqrt(k.normal.squaredNorm());
    k.overlap = reach - distance;
    k.normal *= Lanes(1.0) / distance;
    if constexpr (Law::rolls) k.radius = radius_1 * (reach - radius_1) / reach;
  } else {
    k.overlap = reach;
    k.radius = radius_1;
  }
  const Vec3Of<Lanes> lever = centre + (radius_1 - Lanes(0.5) * k.overlap) * k.normal;
  k.velocity = gather(
      f, [&](const Touch& t) { return frame(t).velocity; }, k.reduced_mass);
  k.spin = gather(
      f, [&](const Touch& t) { return frame(t).spin; }, unused);
  k.velocity += k.spin.cross(lever);
  k.mean_twist = gather(
                     f, [&](const Touch& t) { return frame(t).mean_spin; }, unused)
                     .dot(k.normal);

  ContactMemoryOf<Lanes> memory;
  memory.normal = gather(
      f, [](const Touch& t) { return Row::load(t.memory->normal.data()); }, memory.overlap);
  memory.shear = gather(
      f, [](const Touch& t) { return Row::load(t.memory->shear.data()); }, unused);
  if constexpr (Law::rolls)
    memory.rolling = gather(
        f, [](const Touch& t) { return Row::load(t.memory->rolling.data()); }, unused);

  LossesOf<Lanes> losses;
  const ContactForceOf<Lanes> out = Law::respond(k, p, memory, losses);

  scatter(
      f, [](Touch& t, Row r) { r.store(t.memory->normal.data()); }, memory.normal, memory.overlap);
  scatter(
      f, [](Touch& t, Row r) { r.store(t.memory->shear.data()); }, memory.shear, 0.0);
  if constexpr (Law::rolls)
    scatter(
        f, [](Touch& t, Row r) { r.store(t.memory->rolling.data()); }, memory.rolling, 0.0);
  Vec3Of<Lanes> moment = lever.cross(out.force);
  if constexpr (Law::rolls) moment += out.moment;
  scatter(
      f, [](Touch& t, Row r) { t.force = r; }, out.force, losses.friction);
  scatter(
      f, [](Touch& t, Row r) { t.moment = r; }, moment, losses.rolling);
  for (int lane = 0; lane < Lanes::size; ++lane) f.touch[lane]->dashpot = losses.dashpot[lane];
}

}  // namespace detail

/// Lets all touches respond over a step of length dt [s]. Those with one and the same law and properties go
/// together; no result depends on which do.
template <TouchKind touch_kind>
void respond(Touches& s, double dt) {
  const auto properties_of = [&](int t) {
    return s.frames[static_cast<std::size_t>(s.touches[static_cast<std::size_t>(t)].frame)].properties;
  };
  s.left.resize(s.touches.size());
  for (std::size_t k = 0; k < s.left.size(); ++k) s.left[k] = static_cast<int>(k);
  while (!s.left.empty()) {
    const ContactProperties* p = properties_of(s.left.front());
    s.later.clear();
    detail::Four four;
    int n = 0;
    with_law(p->law, [&]<class Law>() {
      for (int t : s.left) {
        if (properties_of(t) != p) {
          s.later.push_back(t);
          continue;
        }
        four.touch[n++] = &s.touches[static_cast<std::size_t>(t)];
        if (n < Lanes::size) continue;
        detail::respond<Law, touch_kind>(four, s.frames, *p, dt);
        n = 0;
      }
      if (n == 0) return;
      // The last ones are worked out with one of them repeated.
      for (int k = n; k < Lanes::size; ++k) four.touch[k] = four.touch[n - 1];
      detail::respond<Law, touch_kind>(four, s.frames, *p, dt);
    });
    s.left.swap(s.later);
  }
}

}  // namespace trackbed

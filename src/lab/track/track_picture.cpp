// The deformed track with the train, for ParaView.
#include <array>

#include "lab/track/track_record.h"

namespace trackbed {
namespace {

constexpr double wheel_radius = 0.46, body_height = 2.5, body_width = 2.8,
                 overhang = 1.5;  // of what is drawn [m]

/// Collects boxes and lines with a displacement and a force each.
struct Scene {
  PolyData data;
  std::vector<double> point_displacement, line_force, box_force;

  void add_point(const Vec3& place, double displacement) {
    data.points.push_back(place);
    point_displacement.push_back(displacement);
  }
  void add_line(const Vec3& a, double wa, const Vec3& b, double wb, double force) {
    const auto first = static_cast<std::int64_t>(data.points.size());
    add_point(a, wa);
    add_point(b, wb);
    data.lines.push_back({first, first + 1});
    line_force.push_back(force);
  }
  void add_box(const Vec3& low, const Vec3& high, double displacement, double force) {
    const auto first = static_cast<std::int64_t>(data.points.size());
    for (int corner = 0; corner < 8; ++corner)
      add_point(
          {corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(), corner & 4 ? high.z() : low.z()},
          displacement);
    constexpr std::array<std::array<int, 3>, 12> faces{{{0, 2, 1},
                                                        {1, 2, 3},
                                                        {4, 5, 6},
                                                        {5, 7, 6},
                                                        {0, 1, 4},
                                                        {1, 5, 4},
                                                        {2, 6, 3},
                                                        {3, 6, 7},
                                                        {0, 4, 2},
                                                        {2, 4, 6},
                                                        {1, 3, 5},
                                                        {3, 7, 5}}};
    for (const auto& f : faces) {
      data.triangles.push_back({first + f[0], first + f[1], first + f[2]});
      box_force.push_back(force);
    }
  }
};

}  // namespace

PolyData track_picture(const fem::TrackModel& track, const TrackCaseInput& in, double first_wheel,
                       double scale) {
  Scene scene;
  const double shift = approach_start(in.track);
  const SleeperInput& sleeper = in.track.sleeper;
  const double top = 0.15;  // of a rail above the sleeper [m]
  for (const auto& s : track.supports()) {
    const bool on_bridge = s.contacts == 0;
    const double w = track.displacement(s.seat), x = s.x - shift;
    const double along = on_bridge ? in.track.spacing : sleeper.width,
                 across = on_bridge ? in.track.slab.width : sleeper.length;
    const double height = on_bridge ? in.track.slab.depth : sleeper.height;
    scene.add_box({x - along / 2, -across / 2, scale * w - height}, {x + along / 2, across / 2, scale * w}, w,
                  on_bridge ? track.fastener_force(s) : track.ground_force(s));
  }
  for (const double side : {-0.5, 0.5}) {
    const double y = side * sleeper.rail_distance;
    double before_x = track.rail().nodes().front(), before = track.rail_height(before_x);
    for (const double x : track.rail().nodes()) {
      const double w = track.rail_height(x);
      if (x > before_x)
        scene.add_line({before_x - shift, y, top + scale * before}, before, {x - shift, y, top + scale * w},
                       w, 0);
      before_x = x;
      before = w;
    }
  }
  const auto offsets = track.input().vehicle.wheel_offsets();
  for (int wheel = 0; wheel < 4; ++wheel) {
    const double w = track.wheel_height(wheel), x = first_wheel - offsets[static_cast<std::size_t>(wheel)];
    const double z = top + scale * w;
    scene.add_box({x - wheel_radius, -sleeper.rail_distance / 2, z},
                  {x + wheel_radius, sleeper.rail_distance / 2, z + 2 * wheel_radius}, w,
                  track.wheel_force(wheel));
  }
  scene.add_box({first_wheel - offsets[3] - overhang, -body_width / 2, 1.3},
                {first_wheel + overhang, body_width / 2, 1.3 + body_height}, 0, 0);
  std::vector<double> force = scene.line_force;
  force.insert(force.end(), scene.box_force.begin(), scene.box_force.end());
  scene.data.point_data = {{"displacement [m]", scene.point_displacement}};
  scene.data.cell_data = {{"force [N]", std::move(force)}};
  return std::move(scene.data);
}

}  // namespace trackbed

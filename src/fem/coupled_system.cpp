#include "fem/coupled_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

namespace trackbed::fem {
namespace {

constexpr int most_newton_steps = 60, most_conjugate_steps = 2000, most_rest_steps = 60;
constexpr double force_tolerance = 1e-8;      // of the largest force
constexpr double rounding = 1e-6;             // of the largest force: what rounding may leave, at rest
constexpr double conjugate_tolerance = 1e-4;  // of the right-hand side
constexpr double rest_tolerance = 1e-7;       // of the largest displacement

std::size_t at(Index k) {
  return static_cast<std::size_t>(k);
}

/// Grows by these numbers, what is there stays.
void grow(VectorXd& vector, Index by) {
  vector.conservativeResize(vector.size() + by);
  vector.tail(by).setZero();
}

}  // namespace

Index CoupledSystem::add(std::unique_ptr<Part> part) {
  const Index first = u_.size(), n = part->ports();
  for (VectorXd* v : {&u_, &v_, &predicted_u_, &predicted_v_, &port_compliance_}) grow(*v, n);
  part->state(u_.tail(n), v_.tail(n));
  parts_.push_back({std::move(part), first});
  return first;
}

Index CoupledSystem::add(Link link) {
  check(link.law);
  for (VectorXd* v : {&force_, &closing_, &last_force_, &free_closing_, &free_rate_, &compliance_})
    grow(*v, 1);
  links_.push_back(std::move(link));
  memory_.emplace_back();
  left_ends_.emplace_back();
  return links() - 1;
}

void CoupledSystem::move_ends(Index link, std::vector<LinkEnd> ends) {
  left_ends_[at(link)] = std::exchange(links_[at(link)].ends, std::move(ends));
}

void CoupledSystem::set_force(Index link, double force) {
  std::get<GivenForce>(links_[at(link)].law).force = force;
}

void CoupledSystem::set_gap(Index link, double gap) {
  links_[at(link)].gap = gap;
}

double CoupledSystem::closing_of(const std::vector<LinkEnd>& ends, const VectorXd& ports) const {
  double closing = 0;
  for (const LinkEnd& end : ends) closing += end.weight * ports(end.port);
  return closing;
}

VectorXd CoupledSystem::closings_of(const VectorXd& ports) const {
  VectorXd closing(links());
  for (Index k = 0; k < links(); ++k) closing(k) = closing_of(links_[at(k)].ends, ports);
  return closing;
}

/// Forces on ports that push links open.
VectorXd CoupledSystem::to_ports(const VectorXd& forces) const {
  VectorXd ports = VectorXd::Zero(u_.size());
  for (Index k = 0; k < links(); ++k)
    for (const LinkEnd& end : links_[at(k)].ends) ports(end.port) -= end.weight * forces(k);
  return ports;
}

/// Parts know nothing of each other: threads share them, and the bits stay the same.
void CoupledSystem::each_part(const std::function<void(Part& part, Index first)>& work) const {
  for (const auto& [part, first] : parts_)
    if (part->uses_threads()) work(*part, first);
#pragma omp parallel for schedule(dynamic)
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (!parts_[p].part->uses_threads()) work(*parts_[p].part, parts_[p].first);
}

/// G forces: by how much links open.
VectorXd CoupledSystem::answer_to(const VectorXd& forces) const {
  const VectorXd ports = to_ports(forces);
  VectorXd moved(u_.size());
  each_part([&](const Part& part, Index first) {
    part.respond(ports.segment(first, part.ports()), moved.segment(first, part.ports()));
  });
  return -closings_of(moved);
}

void CoupledSystem::make_compliance() {
  for (const auto& [part, first] : parts_)
    port_compliance_.segment(first, part->ports()) = part->compliance();
  if (!at_rest_) return make_groups();
  all_compliance_.resize(links(), links());
  for (Index k = 0; k < links(); ++k) all_compliance_.col(k) = answer_to(VectorXd::Unit(links(), k));
}

void CoupledSystem::make_groups() {
  groups_.clear();
  for (Index k = 0; k < links(); ++k) {
    const int group = links_[at(k)].group;
    if (group < 0) continue;
    if (at(group) >= groups_.size()) groups_.resize(at(group) + 1);
    groups_[at(group)].links.push_back(k);
  }
  for (auto& [members, compliance] : groups_) {
    const auto n = static_cast<Index>(members.size());
    compliance.resize(n, n);
    for (Index k = 0; k < n; ++k)
      compliance.col(k) = answer_to(VectorXd::Unit(links(), members[at(k)]))(members);
  }
}

/// Solves (D + G) x = y within each group, and link by link outside, for links with a slope.
class CoupledSystem::Preconditioner {
 public:
  Preconditioner(const CoupledSystem& system, const VectorXd& slope)
      : scale_((slope.array() > 0)
                   .select((slope.cwiseInverse() + system.compliance_).cwiseInverse(),
                           VectorXd::Zero(slope.size()))) {
    for (const Group& group : system.groups_) {
      std::vector<Index> active, rows;
      for (std::size_t k = 0; k < group.links.size(); ++k)
        if (slope(group.links[k]) > 0)
          active.push_back(group.links[k]), rows.push_back(static_cast<Index>(k));
      if (active.size() < 2) continue;
      Eigen::MatrixXd matrix = group.compliance(rows, rows);
      matrix.diagonal() += VectorXd(slope(active).cwiseInverse());
      blocks_.push_back(
          {std::move(active), matrix.llt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows()))});
    }
  }
  VectorXd operator()(const VectorXd& right) const {
    VectorXd x = scale_.cwiseProduct(right);
    for (const auto& [links, inverse] : blocks_)
      for (std::size_t i = 0; i < links.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < links.size(); ++j)
          sum += inverse(static_cast<Index>(i), static_cast<Index>(j)) * right(links[j]);
        x(links[i]) = sum;
      }
    return x;
  }

 private:
  VectorXd scale_;
  std::vector<std::pair<std::vector<Index>, Eigen::MatrixXd>> blocks_;
};

void CoupledSystem::predict() {
  each_part([&](Part& part, Index first) {
    part.predict(predicted_u_.segment(first, part.ports()), predicted_v_.segment(first, part.ports()));
  });
  free_closing_ = closings_of(predicted_u_);
  for (Index k = 0; k < links(); ++k) free_closing_(k) -= links_[at(k)].gap;
  free_rate_ = closings_of(predicted_v_);
  for (Index k = 0; k < links(); ++k) {
    compliance_(k) = 0;
    for (const LinkEnd& end : links_[at(k)].ends)
      compliance_(k) += end.weight * end.weight * port_compliance_(end.port);
  }
}

CoupledSystem::LawValues CoupledSystem::laws_at(const VectorXd& answer) const {
  LawValues values{VectorXd(links()), VectorXd(links())};
  for (Index k = 0; k < links(); ++k) {
    const double rate = free_rate_(k) - velocity_per_displacement_ * answer(k);
    const LinkForce f = force_of(links_[at(k)].law, memory_[at(k)], free_closing_(k) - answer(k), rate);
    values.force(k) = f.force;
    values.slope(k) = f.stiffness + velocity_per_displacement_ * f.damping;
  }
  return values;
}

/// (1/slope + G) x = right over the links with a slope; zero elsewhere.
VectorXd CoupledSystem::by_factor(const VectorXd& right, const VectorXd& slope) const {
  std::vector<Index> active;
  for (Index k = 0; k < links(); ++k)
    if (slope(k) > 0) active.push_back(k);
  Eigen::MatrixXd matrix = all_compliance_(active, active);
  matrix.diagonal() += VectorXd(slope(active).cwiseInverse());
  VectorXd x = VectorXd::Zero(links());
  x(active) = VectorXd(matrix.llt().solve(VectorXd(right(active))));
  return x;
}

VectorXd CoupledSystem::by_conjugate_gradients(const VectorXd& right, const VectorXd& slope) {
  const auto active = slope.array() > 0;
  const VectorXd diagonal = active.select(slope.cwiseInverse(), 0.0);
  const Preconditioner precondition(*this, slope);
  VectorXd x = VectorXd::Zero(links()), residual = active.select(right, 0.0);
  VectorXd scaled = precondition(residual), direction = scaled;
  double size = residual.dot(scaled);
  const double enough = size * conjugate_tolerance * conjugate_tolerance;
  for (int k = 0; k < most_conjugate_steps && size > enough; ++k, ++effort_.conjugate) {
    const VectorXd image =
        active.select(VectorXd(diagonal.cwiseProduct(direction) + answer_to(direction)), 0.0);
    const double step = size / direction.dot(image);
    x += step * direction;
    residual -= step * image;
    scaled = precondition(residual);
    const double next = residual.dot(scaled);
    direction = scaled + (next / size) * direction;
    size = next;
  }
  return x;
}

/// (1 + slope G) direction = -residual.
VectorXd CoupledSystem::newton_direction(const VectorXd& residual, const VectorXd& slope) {
  const auto active = slope.array() > 0;
  const VectorXd open = active.select(0.0, VectorXd(-residual));
  VectorXd right = active.select(VectorXd(-residual.cwiseQuotient(slope)), 0.0);
  if (open.squaredNorm() > 0) right -= active.select(answer_to(open), 0.0);
  return open + (at_rest_ ? by_factor(right, slope) : by_conjugate_gradients(right, slope));
}

/// About how far forces are from those sought: a stiff link tells little by what its law misses.
double CoupledSystem::error_of(const VectorXd& residual, const VectorXd& slope) const {
  return residual.cwiseQuotient((1 + slope.array() * compliance_.array()).matrix()).cwiseAbs().maxCoeff();
}

/// Finds the forces at the end of the step. Along a direction d the function to be made smallest has the
/// slope d . G (f - law), which only grows; where Newton's full step goes past its zero, that zero is taken.
void CoupledSystem::solve() {
  effort_ = {};
  if (links_.empty()) return;
  VectorXd answer = answer_to(force_);
  LawValues now = laws_at(answer);
  double last_error = std::numeric_limits<double>::infinity();
  for (;; ++effort_.newton) {
    const VectorXd residual = force_ - now.force;
    const double error = at_rest_ ? residual.cwiseAbs().maxCoeff() : error_of(residual, now.slope);
    const double largest = std::max(1.0, now.force.cwiseAbs().maxCoeff());
    if (error <= force_tolerance * largest ||
        (at_rest_ && error <= rounding * largest && error > 0.5 * last_error))
      break;
    last_error = error;
    if (effort_.newton == most_newton_steps)
      throw RunError(
          "the forces between the parts of the track were not found; a smaller time step may help");
    const VectorXd direction = newton_direction(residual, now.slope);
    const VectorXd along = answer_to(direction);
    const auto slope_at = [&](double s) {
      now = laws_at(answer + s * along);
      return along.dot(force_ + s * direction - now.force);
    };
    const double start = std::abs(along.dot(residual));
    double s = 1;
    if (slope_at(s) > 1e-3 * start) {
      double low = 0, high = 1;
      for (int k = 0; k < 30; ++k) {
        s = 0.5 * (low + high);
        const double slope = slope_at(s);
        if (std::abs(slope) <= 0.1 * start) break;
        (slope > 0 ? high : low) = s;
      }
    }
    force_ += s * direction;
    answer += s * along;
  }
  closing_ = free_closing_ - answer;
}

void CoupledSystem::book_energy(const VectorXd& force, const VectorXd& closing, const VectorXd& u) {
  const VectorXd moved = u_ - u;
  for (Index k = 0; k < links(); ++k) {
    const Link& link = links_[at(k)];
    const double mean = 0.5 * (force(k) + force_(k)), closed = closing_(k) - closing(k);
    const std::vector<LinkEnd>& left = left_ends_[at(k)].empty() ? link.ends : left_ends_[at(k)];
    put_in_ +=
        mean * closed - 0.5 * (force(k) * closing_of(left, moved) + force_(k) * closing_of(link.ends, moved));
    left_ends_[at(k)].clear();
    if (const auto* spring = std::get_if<ClampedSpring>(&link.law))
      links_damped_ += spring->damping * closed * closed / step_;
    if (std::holds_alternative<GivenForce>(link.law))
      put_in_ += force_(k) * closing_(k) - force(k) * closing(k) - mean * closed;
    if (std::holds_alternative<MeasuredSupport>(link.law)) {
      LinkMemory after = memory_[at(k)];
      const double before = stored_energy(link.law, after, closing(k));
      after.deepest = std::max(after.deepest, closing_(k));
      links_damped_ += mean * closed - (stored_energy(link.law, after, closing_(k)) - before);
    }
  }
}

void CoupledSystem::advance() {
  const VectorXd ports = to_ports(force_);
  each_part([&](Part& part, Index first) {
    const Index n = part.ports();
    part.advance(ports.segment(first, n));
    part.state(u_.segment(first, n), v_.segment(first, n));
  });
}

/// Steps with a falling shift: large enough at first that nothing falls far, then so small that steps settle.
void CoupledSystem::find_rest() {
  at_rest_ = true;
  velocity_per_displacement_ = 0;
  double shift = 1e5, last_change = 0;
  bool is_slow = true;
  for (int k = 0; k < most_rest_steps; ++k) {
    if (is_slow) {
      shift /= 10;
      for (const auto& [part, first] : parts_) part->rest_by(shift);
      make_compliance();
    }
    const VectorXd before = u_;
    predict();
    solve();
    advance();
    for (Index l = 0; l < links(); ++l)
      memory_[at(l)].deepest = std::max(memory_[at(l)].deepest, closing_(l));
    const double change = (u_ - before).cwiseAbs().maxCoeff();
    const double enough = rest_tolerance * u_.cwiseAbs().maxCoeff();
    // A smaller shift that settles nothing more only makes rounding larger.
    const bool is_rounding = is_slow && change <= 10 * enough && change > 0.5 * last_change;
    if (shift <= 1 && (change <= enough || is_rounding)) return;
    is_slow = shift > 1 || change > 0.1 * last_change;
    last_change = change;
  }
  throw RunError("the track does not come to rest under its weight: something floats");
}

void CoupledSystem::move_by(const TimeScheme& scheme) {
  at_rest_ = false;
  step_ = scheme.step;
  velocity_per_displacement_ = scheme.velocity_per_displacement();
  for (const auto& [part, first] : parts_) {
    part->move_by(scheme);
    part->state(u_.segment(first, part->ports()), v_.segment(first, part->ports()));
  }
  closing_ = closings_of(u_);
  for (Index k = 0; k < links(); ++k) closing_(k) -= links_[at(k)].gap;
  last_force_ = force_;
  links_damped_ = put_in_ = 0;
  make_compliance();
}

void CoupledSystem::step() {
  const VectorXd force = force_, closing = closing_, u = u_;
  force_ += force - last_force_;  // a guess
  last_force_ = force;
  predict();
  solve();
  advance();
  book_energy(force, closing, u);
  for (Index k = 0; k < links(); ++k) memory_[at(k)].deepest = std::max(memory_[at(k)].deepest, closing_(k));
  time_ += step_;
}

SystemEnergy CoupledSystem::energy() const {
  SystemEnergy sum;
  for (const auto& [part, first] : parts_) {
    const PartEnergy e = part->energy();
    sum.parts.kinetic += e.kinetic;
    sum.parts.elastic += e.elastic;
    sum.parts.damped += e.damped;
    sum.parts.numerical += e.numerical;
  }
  for (Index k = 0; k < links(); ++k)
    sum.links += stored_energy(links_[at(k)].law, memory_[at(k)], closing_(k));
  sum.links_damped = links_damped_;
  sum.put_in = put_in_;
  return sum;
}

}  // namespace trackbed::fem

// Laws of the links between parts: the force that resists closing, from how far a link has closed.
#pragma once

#include <variant>
#include <vector>

namespace trackbed::fem {

/// Force of a link [N], pressing positive, and its slopes.
struct LinkForce {
  double force = 0;
  double stiffness = 0;  // d force / d closing [N/m], 0 or more
  double damping = 0;    // d force / d rate of closing [N s/m], 0 or more
};

/// A force that is given: a moving load.
struct GivenForce {
  double force = 0;  // [N]
};

/// Clamped spring and dashpot with another stiffness in tension: the fastener. tension = compression: linear.
struct ClampedSpring {
  double compression = 0, tension = 0;  // [N/m]
  double damping = 0;                   // [N s/m]
};

/// A spring that never pulls: sleeper on ballast, penalty form.
struct OneSidedSpring {
  double stiffness = 0;  // [N/m]
};

/// Hertz (1881): force = constant closing^1.5 while closed: wheel on rail.
struct HertzContact {
  double constant = 0;  // [N/m^1.5]
};

/// A support measured under load: a curve of first loading, unloading along lines of a constant slope, and
/// first loading again where it was left. It never pulls.
struct MeasuredSupport {
  std::vector<double> closing,
      force;             // of first loading: ascending, from a force of 0; goes on with the last slope
  double unloading = 0;  // [N/m], at least the steepest slope of the curve
};

using LinkLaw = std::variant<GivenForce, ClampedSpring, OneSidedSpring, HertzContact, MeasuredSupport>;

/// What a law remembers from step to step.
struct LinkMemory {
  double deepest = 0;  // closing reached so far [m] (MeasuredSupport)
};

/// Force at a closing [m] and its rate [m/s]. The force never falls with either.
LinkForce force_of(const LinkLaw& law, const LinkMemory& memory, double closing, double rate);

/// Energy that comes back when a link opens [J].
double stored_energy(const LinkLaw& law, const LinkMemory& memory, double closing);

/// Spring constant about the static load of a Hertzian contact, 1.5 C^(2/3) F^(1/3) [N/m].
double hertz_stiffness(double constant, double force);

/// Throws std::invalid_argument with a sentence when a law has a negative constant or a curve that falls.
void check(const LinkLaw& law);

}  // namespace trackbed::fem

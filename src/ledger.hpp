// Energies of the particles, and the start of the energy ledger. The stage `account` keeps it from there on.
#pragma once

#include "world.hpp"

namespace gp {

// J per metre of depth.
struct Energies {
    double kinetic = 0, potential = 0, elastic = 0;
    double sum() const { return kinetic + potential + elastic; }
};

// Over one stretch of a world's particles after the other (stretches.hpp).
class EnergySums {
public:
    explicit EnergySums(const World &world);
    void add(const World &stretch);
    const Energies &all() const { return sums_; }

private:
    Energies sums_;
};

// Of all processes, and the same on all, as what follows.
Energies measure_energies(const World &world);

// Energy of the start, and the height from which the potential counts.
void open_ledger(World &world);

// Gravity from now on. The potential goes on from where it is, so that the ledger closes as before: it is what gravity has not
// yet done of its work. What counts as much energy and as little is told from where the material now is.
// What fails changes nothing.
void change_gravity(World &world, const Vector &gravity);

} // namespace gp

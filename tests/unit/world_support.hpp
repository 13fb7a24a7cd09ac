// Worlds for the unit tests: particles on a lattice, with or without jitter, and the stages called by hand.
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "scene.hpp"
#include "stages/stages.hpp"
#include "undo.hpp"
#include "world.hpp"

namespace test {

// The gradient, without the stages of the density to which it leaves something.
inline void make_gradient(gp::World &world) {
    gp::stages::flowing(world);
    gp::stages::gradient(world);
    world.particles.give_back(false);
}

// Stress and force, of a step that is good, without what the density leaves to the force for collisions.
inline void make_force(gp::World &world) {
    world.crowded = {};
    gp::stages::stress(world);
    gp::stages::force(world);
    gp::accept_step(world);
}

struct Block {
    // n x n particles on the unit square, displaced at random by up to jitter spacings.
    Block(int n, double jitter, double penalty = 0, unsigned seed = 1) {
        gp_config config = gp::default_config(GP_PRESET_DEFAULT);
        config.spacing = 1.0 / n;
        config.gravity_y = 0;
        config.sound_speed = 10;
        config.zero_energy_penalty = penalty;
        config.bulk_viscosity = 0;
        config.threads = 1;
        config.jitter = jitter;
        config.seed = seed;
        scene = std::make_unique<gp::Scene>(config);
        gp_column column = gp::default_column();
        column.width = column.height = 1;
        std::string note;
        scene->add_column(column, note);
        world = gp::make_world(*scene);
        gp::stages::update_neighbors(*world);
    }

    // Sets a field of the particles from their positions.
    template <class Function> void set(gp::Field<double> &field, const Function &function) {
        const gp::Particles &p = world->particles;
        for (int64_t i = 0; i < p.count; ++i)
            field[i] = function(p.x[i], p.y[i]);
    }
    void randomise(gp::Field<double> &field, double low, double high) {
        std::uniform_real_distribution<double> uniform(low, high);
        for (double &value : field)
            value = uniform(generator);
    }
    double sum(double gp::BlockSums::*member) const {
        double total = 0;
        for (const gp::BlockSums &block : world->sums)
            total += block.*member;
        return total;
    }

    std::unique_ptr<gp::Scene> scene;
    std::unique_ptr<gp::World> world;
    std::mt19937 generator{7};
};

} // namespace test

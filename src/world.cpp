#include "world.hpp"

#include "parallel.hpp"

namespace gp {

namespace {

// kg/m, added up particle by particle: of all that there are, whoever has them.
double mass_of(const Scene &scene, const Constants &constants) {
    double mass = 0;
    for (const Body &body : scene.bodies()) {
        const double own = constants.materials[body.material].density * constants.volume;
        for (int64_t k = 0; k < body.count; ++k)
            mass += own;
    }
    return mass;
}

} // namespace

std::unique_ptr<World> make_bare_world(const Scene &scene, const Constants &constants, int64_t count) {
    auto world = std::make_unique<World>();
    world->scene = &scene;
    world->constants = constants;
    world->mass = mass_of(scene, constants);
    const int32_t threads = scene.config().threads;
    world->threads = threads > 0 ? threads : default_threads();
    const Constants &c = world->constants;

    Particles &p = world->particles;
    p.volume = c.volume;
    const bool exchanged = scene.config().density_diffusion > 0;
    Particles::Optional use;
    use.stressed = c.penalty > 0 && c.scheme != Scheme::adjoint;
    use.fluidity = c.fluid;
    use.bearing_flow = exchanged && c.fluid && c.one_density();
    use.densities = exchanged && !c.one_density();
    use.shape = c.scheme != Scheme::paper_local;
    use.mean_pressure = c.rate_dependent;
    use.syy = by_number_density(c.scheme);
    use.sleep = scene.config().sleep == 1;
    p.allocate(count, use);
    world->sleep.in_use = scene.config().sleep == 1;
    const int64_t blocks = block_count(count);
    world->sums.resize(blocks);
    world->ranges.resize(blocks);
    if (scene.config().collision_distance > 0)
        world->colliding.resize(count);
    if (scene.config().collision_distance > 0 && !by_number_density(c.scheme))
        world->crowded.resize(count);
    world->walls.period = c.period;
    world->walls.load_scale = LoadScale(c);
    for (const PlateSpec &spec : scene.plates())
        world->walls.plates.emplace_back(spec);
    world->walls.make_facets(scene);
    return world;
}

void begin_particles(World &world, int64_t first) {
    const Scene &scene = *world.scene;
    const Constants &c = world.constants;
    Particles &p = world.particles;
    const std::vector<InitialStress> stress = scene.initial_stress(c, first, first + p.count);
    int32_t b = scene.body_of(first);
    for (int64_t i = 0; i < p.count; ++i) {
        const int64_t id = first + i;
        while (id >= scene.bodies()[b].first + scene.bodies()[b].count)
            ++b;
        const Body &body = scene.bodies()[b];
        const Vector at = scene.position(body, id), velocity = scene.velocity(body, id);
        p.id[i] = id;
        p.column[i] = b;
        p.x[i] = at.x();
        p.y[i] = at.y();
        p.vx[i] = velocity.x();
        p.vy[i] = velocity.y();
        p.pressure[i] = stress[i].pressure;
        if (c.rate_dependent)
            p.mean_pressure[i] = stress[i].pressure;
        p.sxx[i] = stress[i].sxx;
        p.sxy[i] = stress[i].sxy;
        p.density[i] = world.material_of(i).density + stress[i].pressure / (c.sound_speed * c.sound_speed);
    }
    world.walls.place_plates(0, c.spacing / c.wave_speed);
}

std::unique_ptr<World> make_world(const Scene &scene) {
    std::unique_ptr<World> world = make_bare_world(scene, scene.constants(), scene.particle_count());
    begin_particles(*world, 0);
    return world;
}

} // namespace gp

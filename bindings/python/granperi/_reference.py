"""What gp.h says of each parameter and value, in the names of this package: {struct: {name: (type, meaning)}}.

Written by bindings/generate from include/granperi/gp.h. Do not edit.
"""

MEANINGS: dict[str, dict[str, tuple[str, str]]] = {
    "gp_config": {
        "spacing": ("float", "m, particle distance dl; 1e-9 .. 1e9 [0.0025]"),
        "gravity_x": ("float", "m/s2 [0]"),
        "gravity_y": ("float", "m/s2 [-9.81]"),
        "sound_speed": ("float",
            "m/s, artificial; 0: 10 x the largest speed that the scene can reach by falling from its highest to its "
            "lowest point, by its initial and plate velocities; or, if that is more, 60 x the speed of the hardest "
            "blow that it begins with: of a column that falls freely, through an opening too, or is thrown, against a "
            "plate or another column (not with Density.NUMBER, nor with a time_step). The log says so and what it "
            "costs. Else at least 1e-9 [0]"),
        "cfl": ("float",
            "time step over dl / (elastic wave speed), with Stress.REGULARIZED dl / c0; 0: the scheme's own (horizon "
            "2.5: 0.59, 3: 0.71, 4: 0.95, 6: 1.42), by the default coefficients half of State.dt_limit, down to 0.42 "
            "of it where the material moves by more than 0.06 dl in a step and where a blow is foreseen; of the "
            "schemes of [1] 0.2. Else 1e-6 .. 8; beyond State.dt_limit (for these horizons 1.18, 1.44, 1.93, 2.88, in "
            "the schemes of [1] 1.0) it is refused at the first step, but see allow_unstable_step [0]"),
        "time_step": ("float",
            "s, fixed; 0: adaptive, by the smallest of the limits StepLimit.SOUND to StepLimit.VISCOSITY. Beyond "
            "State.dt_limit: refused at the first step, but see allow_unstable_step [0]"),
        "interaction_radius": ("float",
            "dl, support of the number density and of the paper's MPS operators; 1.5 .. 8 [4]"),
        "horizon": ("float",
            "dl, radius of the peridynamic operators; 1.8 .. 8: below, neighbours are too few [4]"),
        "horizon_length": ("float", "m, the horizon as a fixed length; 0: use horizon [0]"),
        "nonlocal_": ("int", "1: peridynamic force states; 0: local model [1]"),
        "stress": ("Stress", "one of \"elastic\", \"regularized\", \"implicit\" [\"elastic\"]"),
        "density": ("Density", "one of \"continuity\", \"number\" [\"continuity\"]"),
        "friction_factor": ("float",
            "multiplies mu(I): [1] equation 3.12 as printed amounts to 2; 0 .. 10 [1]"),
        "delta": ("float",
            "1/s, regularisation of the viscosity ([1] 3.6); with Stress.ELASTIC only of the reported one; with "
            "Stress.IMPLICIT 1e-4 and below leave the same deposit; > 0 [1e-6]"),
        "collision_distance": ("float",
            "dl, closer approaching pairs of which both flow collide (in the schemes by number density all; [1] 2.9); "
            "0: off; 0 .. 1 [0.9]"),
        "zero_energy_penalty": ("float",
            "of the velocity that the gradient does not see, in rho c0 / dl; inside the yield surface at least 0.2 "
            "with Stress.ELASTIC; 0: off; 0 .. 0.5 [the scheme's own: 0.02]"),
        "density_diffusion": ("float",
            "smoothing of the density where the material flows, in c0 dl; 0: off; 0 .. 1 [the scheme's own: 0.2]"),
        "channel_width": ("float",
            "m, W between the side walls; 0: none. Their friction, averaged over the width, is 2 channel_friction p / "
            "W per volume against the velocity, and holds what it can [0]"),
        "channel_friction": ("float",
            "Coulomb coefficient of the side walls; needs channel_width [0]"),
        "periodic_x_min": ("float",
            "m; with periodic_x_max > periodic_x_min the scene is periodic in x: columns and particles begin within, "
            "positions return into the period now and then (they may be beyond its ends by less than a spacing), and "
            "a plate reaches over the period at most: one that just spans it has no ends"),
        "periodic_x_max": ("float",
            "m; the period is at least twice the horizon and the interaction radius and two spacings more; best a "
            "whole number of spacings [0, 0]"),
        "threads": ("int",
            "threads that work on this simulation, the calling one among them; 0: OpenMP's default (all processors, "
            "or OMP_NUM_THREADS); 0 .. 1024 [1]. The results are the same bits for any number"),
        "seed": ("int", "of the jitter [0]"),
        "jitter": ("float",
            "dl, columns' particles are displaced at random by up to this much in x and y; 0 .. 0.5 (exclusive) [0]"),
        "preset": ("Preset",
            "one of \"default\", \"paper\", \"paper_local\", set by Config(preset)"),
        "bulk_viscosity": ("float",
            "of volume changes under pressure and, inside the yield surface, of shear, in rho c0 dl: it damps elastic "
            "waves and does not act at rest; 0: off; 0 .. 1 [the scheme's own: 0.1]"),
        "implicit_tolerance": ("float",
            "with Stress.IMPLICIT: the solve of a step has converged when what is left of the momentum balance is "
            "below this share of the forces in it (root mean squares), and the rates fit the stress to its root; "
            "1e-12 .. 1e-2 [1e-5]"),
        "implicit_iterations": ("int",
            "with Stress.IMPLICIT: Newton steps that one solve may take; a solve that needs more is DivergedError; 1 "
            ".. 10000 [100]"),
        "allow_unstable_step": ("int",
            "1: a demanded time_step or cfl beyond the stable limit is taken, with a warning; 0: it is refused [0]"),
        "retry_halvings": ("int",
            "a step that diverges is taken anew from where it began in two halves, these in halves again and so on, "
            "up to this many times; 0: it is DivergedError at once; 0 .. 20 [0]"),
        "sleep": ("int",
            "1: what rests is left out of the work (gp_step, \"Sleep\"); 0: all material is computed in every step. "
            "Only with the default scheme, else UnsupportedError; 0 .. 1 [0]"),
    },
    "gp_material": {
        "grain_density": ("float", "kg/m3, rho_s; > 0 [2500]"),
        "volume_fraction": ("float", "phi, so rho = phi rho_s; > 0, <= 1 [0.62]"),
        "grain_diameter": ("float", "m, d; > 0 [0.002]"),
        "mu_s": ("float", "friction at I = 0; >= 0 [tan 21 deg]"),
        "mu_2": ("float", "friction at large I; >= mu_s [tan 32 deg]"),
        "i0": ("float", "I at which mu is half way between; > 0 [0.3]"),
        "nonlocal_amplitude": ("float",
            "A of the granular fluidity [4], its length over grain_diameter; 0: the local mu(I) law; 0 .. 10; glass "
            "beads 0.48, discs 0.9. Needs mu_2 > mu_s > 0 and friction_factor > 0, and spacings of half a grain to "
            "resolve it; only with the default scheme, else UnsupportedError. Uniform steady flow is mu(I) as well "
            "[0]"),
        "fluidity_time": ("float",
            "s, t0 in which the fluidity follows; > 0; only with nonlocal_amplitude [1e-4]"),
        "k0": ("float",
            "sigma_h / sigma_v with which columns begin (InitialPressure.HYDROSTATIC), the stress across over that "
            "along the direction in which a column presses; 0: isotropic, or none across as Column.initial_pressure "
            "says. Within yield: (1 - m) / (1 + m) .. (1 + m) / (1 - m) with m = friction_factor mu_s, any above 0 "
            "where m >= 1. Else than 0 only with Stress.ELASTIC. Walls' friction begins unmobilised: side walls bear "
            "k0 sigma_v, the base all of the weight. Below 1 it is also the ratio in which the stresses change where "
            "the material cannot spread, by its shear modulus, (1 - k0) / (1 + k0) of the bulk modulus, at least .1 "
            "(without k0 .3): it stays while walls take weight over, until the material yields; beside walls as rough "
            "as itself it then tends to 1. Columns side by side are in balance if they have the same one [0]"),
    },
    "gp_column": {
        "x_min": ("float", "m, lower left corner"),
        "y_min": ("float", "m, lower left corner"),
        "width": ("float",
            "m; > 0, rounded to whole spacings (the log says so), at least one"),
        "height": ("float",
            "m; > 0, rounded to whole spacings (the log says so), at least one"),
        "material": ("int", "id of Simulation.add_material; 0 is always there [0]"),
        "vx": ("float", "m/s, initial velocity [0, 0]"),
        "vy": ("float", "m/s, initial velocity [0, 0]"),
        "initial_pressure": ("InitialPressure",
            "one of \"hydrostatic\", \"none\" [\"hydrostatic\"]. Hydrostatic: p = rho |g.n| depth below the opposite face, "
            "for each face of normal n into which gravity presses and at least half of which rests on plates or on "
            "other hydrostatic columns so borne; to it is added what rests on the opposite face: such columns, and "
            "the normal_pressure of plates. 0 where nothing bears. With Stress.ELASTIC, where one such face alone "
            "bears and no plate loads the other: the shear stress rho g.t depth along that face too, as far as the "
            "friction of the material and of the plates under it bears it; and where a side is free and mu_s >= 1, so "
            "that the friction holds it, no stress across: half the pressure, the other half as deviator. No effect "
            "with Density.NUMBER"),
    },
    "gp_plate": {
        "x0": ("float",
            "m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is "
            "on the right; the plate acts on material on that side only, so a plate wetted on both sides is two "
            "plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of "
            "both sides at their foot. The two ends differ"),
        "y0": ("float",
            "m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is "
            "on the right; the plate acts on material on that side only, so a plate wetted on both sides is two "
            "plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of "
            "both sides at their foot. The two ends differ"),
        "x1": ("float",
            "m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is "
            "on the right; the plate acts on material on that side only, so a plate wetted on both sides is two "
            "plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of "
            "both sides at their foot. The two ends differ"),
        "y1": ("float",
            "m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is "
            "on the right; the plate acts on material on that side only, so a plate wetted on both sides is two "
            "plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of "
            "both sides at their foot. The two ends differ"),
        "friction": ("Wall", "one of \"no_slip\", \"free_slip\", \"coulomb\" [\"no_slip\"]"),
        "wall_mu": ("float", "Coulomb coefficient, for Wall.COULOMB only; >= 0 [0]"),
        "vx": ("float", "m/s, constant velocity; not with a table [0, 0]"),
        "vy": ("float", "m/s, constant velocity; not with a table [0, 0]"),
        "n_knots": ("int", "length of the displacement table; 0: none [0]"),
        "knot_t": ("np.ndarray | None", "s, shape (n_knots), strictly increasing"),
        "knot_x": ("np.ndarray | None",
            "m, shape (n_knots), displacement; linear between knots, at rest before and after"),
        "knot_y": ("np.ndarray | None", "m, shape (n_knots)"),
        "normal_pressure": ("float",
            "Pa, a load on the plate's back: the plate moves along its normal as a rigid body under this load and the "
            "material's reaction (its own weight is part of the load), and along its tangent as prescribed: vx, vy "
            "then have no normal part, and there is no table and no turn. Of a line of several points the straight "
            "way from the first to the last counts; a closed one bears no load. 0: all of the motion is prescribed "
            "[0]"),
        "mass_per_length": ("float",
            "kg/m2, inertia of a loaded plate per length; only with normal_pressure. 0: light, as half a spacing of "
            "the heaviest material: it follows its load at once. A heavy plate rings on confined material, which "
            "damps its slow motion little [0]"),
        "n_points": ("int",
            "0: the plate is the segment from (x0, y0) to (x1, y1); 2 to 10 000 000: it is the line through that many "
            "points, with x0 to y1 0: one wall, one friction, one motion, one load. Its segments are no shorter than "
            "a tenth of the spacing, and it does not cross, touch or fold back on itself. No joint of it is felt, but "
            "for corners of more than 50 degrees and bulges of more than that within a horizon [0]"),
        "point_x": ("np.ndarray | None",
            "m, shape (n_points); body on the left of the way. Last point = first point: a closed line, as a drum "
            "(clockwise: material inside) or an obstacle (counter-clockwise) [None]"),
        "point_y": ("np.ndarray | None", "m, shape (n_points) [None]"),
        "pivot_x": ("float",
            "m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a "
            "periodic scene is no longer, corner to corner, than the period [0, 0]"),
        "pivot_y": ("float",
            "m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a "
            "periodic scene is no longer, corner to corner, than the period [0, 0]"),
        "omega": ("float",
            "rad/s, constant rate of turning, counter-clockwise; not with a table or a load [0]"),
        "knot_angle": ("np.ndarray | None",
            "rad, shape (n_knots), counter-clockwise, as knot_x; knot_x and knot_y may then both be None, for none. "
            "None: the table does not turn the plate [None]"),
        "surface_velocity": ("float",
            "m/s, along the line from its first point to its last, of the wall's surface alone, which stays where it "
            "is: a belt, a turning roll. Not with Wall.FREE_SLIP [0]"),
        "fluidity": ("Fluidity",
            "one of \"free\", \"zero\", of materials with nonlocal_amplitude [\"free\"]"),
    },
    "gp_output": {
        "every_seconds": ("float",
            "s; > 0: a frame at the start and after the first step at or past each multiple; 0: only by Output.write "
            "[0]"),
        "fields": ("int",
            "GP_FIELD_...; x and y come together, so do vx and vy; id and position are always written [position, "
            "velocity, pressure, shear_rate, column]"),
        "compression": ("int", "deflate level, 0 .. 9 [4]"),
        "single_precision": ("int",
            "1: floating-point fields as 32 bits [0]. Times, the state and positions stay 64; positions are rounded "
            "to 1e-5 spacings, wherever they are, which compresses as well as 32 bits"),
        "append": ("int",
            "1: an existing file of this simulation is continued, see Simulation.output; 0: it is replaced [0]"),
    },
    "gp_state": {
        "time": ("float", "s"),
        "step": ("int", "steps taken"),
        "dt": ("float", "s, last time step"),
        "n_particles": ("int", "how many there are"),
        "n_awake": ("int",
            "particles that take part in the work: all of them but for those that sleep (Config.sleep)"),
        "kinetic": ("float",
            "Energy ledger, J per metre of depth: the initial kinetic + potential + elastic energy equals kinetic + "
            "potential + elastic + dissipated + plate_work + energy_error."),
        "potential": ("float",
            "gravitational, zero at the lowest face of the initial material. Simulation.set_gravity leaves it as it "
            "is: from there on it is less by what the new gravity has done, and may fall below 0"),
        "elastic": ("float", "of compression and shear"),
        "dissipated": ("float", "by friction, collisions, walls and the scheme itself"),
        "plate_work": ("float", "done by the material on moving plates"),
        "energy_error": ("float",
            "what the ledger does not account for: error of the time integration; in the schemes of [1] also that of "
            "their operators, which are not adjoint: several per cent of the energy, and at rest more and more of it "
            "is dissipated on paper alone (below 0)"),
        "momentum_x": ("float", "kg/s: kg m/s per metre of depth"),
        "momentum_y": ("float", "kg/s: kg m/s per metre of depth"),
        "max_speed": ("float", "m/s"),
        "rms_speed": ("float", "m/s"),
        "x_left": ("float",
            "m, fronts of the connected deposit: the largest set of particles each within 1.6 dl of another, half a "
            "spacing added"),
        "x_right": ("float",
            "m, fronts of the connected deposit: the largest set of particles each within 1.6 dl of another, half a "
            "spacing added"),
        "peak_x": ("float",
            "m, highest point of its surface: x, and y (an absolute coordinate). Extrapolated from the surface "
            "smoothed over 6 and 3 dl to one that is not: without bias at a cusp, on a plateau, and beside walls. "
            "Single grains scatter it by some 0.3 dl. Of a deposit too thin for that, and by itself in space, the "
            "highest of Simulation.surface"),
        "peak_height": ("float",
            "m, highest point of its surface: x, and y (an absolute coordinate). Extrapolated from the surface "
            "smoothed over 6 and 3 dl to one that is not: without bias at a cusp, on a plateau, and beside walls. "
            "Single grains scatter it by some 0.3 dl. Of a deposit too thin for that, and by itself in space, the "
            "highest of Simulation.surface"),
        "max_pressure": ("float", "Pa"),
        "at_rest": ("int",
            "1: the material has come to rest: the kinetic energy is below 1e-6 of the scene's energy scale, the "
            "plastic power of the last step would dissipate less than 1e-4 of it in the scene's free-fall time, and "
            "no more than 1 % of the mass is accelerated by more than 0.05 g, on average over some 20 steps (single "
            "grains at yield, at tips and surfaces, may push each other; of fewer than 200 particles two, but no more "
            "than 5 % of the mass). And no plate has motion of its own left (a velocity or a turn, also of "
            "Simulation.set_plate_motion, a belt, or knots that displace it further) that is within the horizon of "
            "the box around all particles, or will come so near on its way, as straight lines between here and the "
            "farthest places that it comes to have it; a plate under a load there rests itself: its kinetic energy is "
            "below the same 1e-6, and the material bears its load within 5 %. The energy scale is the largest of the "
            "initial energy of the ledger and the largest kinetic energy so far; after Simulation.set_gravity the "
            "energy then, with the potential from the lowest face of the material on, and the largest kinetic energy "
            "since"),
        "collisions": ("int",
            "colliding pairs so far ([1] 2.9), each step's counted anew; with them half of the pairs that are as "
            "close and approach, but of which only one particle flows"),
        "wall_seconds": ("float", "s of wall-clock time inside the steps so far"),
        "sound_speed": ("float", "m/s, c0 in use"),
        "penalty_dissipated": ("float",
            "J/m, the part of dissipated that the zero-energy penalty took, and with Stress.IMPLICIT the like of it "
            "in the solve"),
        "wall_dissipated": ("float",
            "J/m, the part taken at plates beyond the material's own: by the extrapolation, of either sign, and by "
            "the friction of rough plates"),
        "diffusion_dissipated": ("float", "J/m, the part that density diffusion took"),
        "bulk_dissipated": ("float", "J/m, the part that the bulk viscosity took"),
        "collision_dissipated": ("float", "J/m, the part that collisions took"),
        "channel_dissipated": ("float", "J/m, the part that the friction of side walls took"),
        "dt_reason": ("StepLimit",
            "one of \"none\", \"sound\", \"flow\", \"plate\", \"viscosity\", \"demanded\", \"end\", \"retry\": what set dt"),
        "implicit_last": ("int",
            "Newton steps of the last step's solve; this and the next four with Stress.IMPLICIT only, else 0"),
        "implicit_newton": ("int", "Newton steps so far"),
        "implicit_linear": ("int", "iterations of conjugate gradients so far"),
        "implicit_failures": ("int",
            "solves that did not converge, so far: each is DivergedError or a retry"),
        "implicit_residual": ("float", "of the last solve, as Config.implicit_tolerance"),
        "retries": ("int", "steps undone and taken anew so far (Config.retry_halvings)"),
        "dt_limit": ("float",
            "s, the largest time_step that is stable for this scene: for waves, loaded plates and the coefficients "
            "that damp, not for the flow"),
        "max_compression": ("float", "largest density over the material's own so far, less 1"),
        "spacing_dissipated": ("float",
            "J/m, the part that making the density follow the spacing of the particles took: below 0, it compresses "
            "what flows"),
        "x_q01": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q05": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q25": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q50": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q75": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q95": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "x_q99": ("float",
            "Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached "
            "grains too. Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its "
            "marks at .01 L, .05 L, ...; where a mark falls into a gap it is the gap's middle. In a periodic scene "
            "what reaches beyond an end of the period counts at the other. Unlike the fronts x_left and x_right, "
            "which single grains set, they converge with the spacing. 0 without particles, as the next four"),
        "centre_x": ("float", "m, centre of mass"),
        "centre_y": ("float", "m, centre of mass"),
        "detached": ("float",
            "share of the mass outside of the connected deposit (of x_left), 0 .. 1: what x_left, x_right and the "
            "peak do not know of"),
        "volume_drift": ("float",
            "mean number density where the material flows over that at the start, less 1: above 0 it has lost volume, "
            "whatever its density says. Number density: sum of (1 - r^2 / R^2)^2 over a particle and its neighbours "
            "within the horizon R, ghosts behind plates included. Flows: at yield, under pressure, and sheared by "
            "more than 0.01 in the scene's free-fall time. Only particles whose horizon is full count (a neighbour in "
            "each eighth of its outermost 1.25 dl), so free surfaces have no part in it; at the start all of these, "
            "of the lattice if there are none. 0 where nothing flows. Layers that keep their height stay within .01; "
            "what topples and spreads opens up, by some 0.5 dl / height. Above .02 gp_set_log warns"),
        "gravity_x": ("float", "m/s2, in force from here on"),
        "gravity_y": ("float", "m/s2, in force from here on"),
    },
    "gp_load": {
        "fx": ("float", "N/m, force of the material on the plate over the last step"),
        "fy": ("float", "N/m, force of the material on the plate over the last step"),
        "torque": ("float",
            "N, its moment about the plate's first point, counter-clockwise"),
        "dx": ("float",
            "m, displacement of the plate, where it turns of its pivot, since the start"),
        "dy": ("float",
            "m, displacement of the plate, where it turns of its pivot, since the start"),
        "impulse_x": ("float", "N s/m, integral of fx and fy over time since the start"),
        "impulse_y": ("float", "N s/m, integral of fx and fy over time since the start"),
        "torque_pivot": ("float",
            "N, moment of the force about the plate's pivot, counter-clockwise"),
        "angle": ("float", "rad, by which it has turned since the start"),
        "impulse_torque": ("float", "N s, integral of torque_pivot over time since the start"),
    },
    "gp_plan_entry": {
        "name": ("str", "static text"),
        "reason": ("str", "static text: why it is active or left out"),
        "kind": ("int",
            "0: stage, in the order in which they run; 1: field or table; 2: between processes (gp_mpi.h)"),
        "active": ("int", "1, or 0 if this scene leaves it out"),
        "bytes": ("int", "of memory held; 0 for a stage"),
        "seconds": ("float", "wall-clock time spent so far; 0 for a field"),
        "calls": ("int", "times run so far; 0 for a field"),
    },
}

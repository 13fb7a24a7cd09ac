// The scenes of trust_host (host.cpp), and what its host does in them.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "granperi/gp.h"

inline void check(gp_status status, const char *call) {
    if (status >= 0)
        return;
    std::fprintf(stderr, "%s: %s: %s\n", call, gp_status_string(status), gp_last_error());
    std::exit(1);
}
#define CHECK(call) check(call, #call)

struct SceneOptions {
    std::string scene;
    int size = 1, threads = 1;
    bool spare_plate = false, spare_body = false, unused_material = false;
};

// What a scene has behind it where it begins: to fall asleep takes some 500 steps.
int64_t steps_before(const std::string &scene);

gp_sim *make(const SceneOptions &o);

// What the host does before a step, whatever the process.
void drive(gp_sim *sim, const std::string &scene, int64_t step);

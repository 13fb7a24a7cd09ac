// struct_size: programs compiled against an older or a newer header.
#include "api_support.hpp"

using namespace api;

namespace {

constexpr unsigned char guard_byte = 0xa5;

// A struct of any size in memory of exactly that size, so that a checker of memory sees every byte too far.
class Bytes {
public:
    Bytes(const void *from, std::size_t known, std::size_t size, unsigned char rest)
        : data_(size, static_cast<char>(rest)) {
        data_.shrink_to_fit();
        std::memcpy(data_.data(), from, std::min(known, size));
    }
    template <class T> T *as() { return reinterpret_cast<T *>(data_.data()); }
    Bytes &say(std::size_t size) {
        const auto value = static_cast<uint32_t>(size);
        std::memcpy(data_.data(), &value, sizeof value);
        return *this;
    }
    void set(std::size_t at, char value) { data_[at] = value; }
    bool all(std::size_t from, unsigned char value) const {
        for (std::size_t k = from; k < data_.size(); ++k)
            if (static_cast<unsigned char>(data_[k]) != value)
                return false;
        return true;
    }
    const std::vector<char> &copy() const { return data_; }

private:
    std::vector<char> data_;
};

gp_status init_config(gp_config *config, size_t size) {
    return gp_config_init(config, size, GP_PRESET_DEFAULT);
}

template <class T> void check_init(gp_status (*init)(T *, size_t), const char *name) {
    SCOPED_TRACE(name);
    T whole;
    ASSERT_EQ(init(&whole, sizeof whole), GP_OK);
    EXPECT_EQ(whole.struct_size, sizeof whole);
    // An older program's size: not a byte beyond it is written.
    for (std::size_t size = 8; size <= sizeof(T); size += 4) {
        Bytes bytes("", 0, sizeof(T) + 16, guard_byte);
        ASSERT_EQ(init(bytes.as<T>(), size), GP_OK) << size;
        EXPECT_EQ(bytes.as<T>()->struct_size, size);
        EXPECT_EQ(std::memcmp(bytes.copy().data() + 4, reinterpret_cast<char *>(&whole) + 4, size - 4), 0) << size;
        EXPECT_TRUE(bytes.all(size, guard_byte)) << size;
    }
    // A newer program's: the fields that this version does not know are zero.
    Bytes longer("", 0, sizeof(T) + 64, guard_byte);
    ASSERT_EQ(init(longer.as<T>(), sizeof(T) + 48), GP_OK);
    EXPECT_EQ(longer.as<T>()->struct_size, sizeof(T) + 48);
    const std::vector<char> copy = longer.copy();
    for (std::size_t k = sizeof(T); k < sizeof(T) + 48; ++k)
        EXPECT_EQ(copy[k], 0);
    EXPECT_TRUE(longer.all(sizeof(T) + 48, guard_byte));
    // No struct at all.
    for (const std::size_t size : {std::size_t(0), std::size_t(4), std::size_t(7), SIZE_MAX}) {
        Bytes bytes("", 0, sizeof(T), guard_byte);
        EXPECT_FAILS(init(bytes.as<T>(), size), GP_E_ARGUMENT, "size");
        EXPECT_TRUE(bytes.all(0, guard_byte));
    }
    EXPECT_FAILS(init(nullptr, sizeof(T)), GP_E_ARGUMENT, name);
}

// `use` hands the struct to the library.
template <class T, class Use> void check_input(const T &valid, const char *name, const Use &use) {
    SCOPED_TRACE(name);
    for (const std::size_t size : {0, 1, 4, 7}) {
        Bytes bytes(&valid, sizeof valid, sizeof valid, 0);
        EXPECT_FAILS(use(bytes.say(size).as<T>()), GP_E_ARGUMENT, "struct_size");
    }
    EXPECT_EQ(use(&valid), GP_OK) << gp_last_error();
    for (const std::size_t more : {1, 8, 40, 1000}) {
        Bytes bytes(&valid, sizeof valid, sizeof valid + more, 0);
        bytes.say(sizeof valid + more);
        EXPECT_EQ(use(bytes.as<T>()), GP_OK) << gp_last_error();
        bytes.set(sizeof valid + more - 1, 1);
        EXPECT_FAILS(use(bytes.as<T>()), GP_E_VERSION, "struct_size");
        bytes.set(sizeof valid + more - 1, 0);
        bytes.set(sizeof valid, 1);
        EXPECT_FAILS(use(bytes.as<T>()), GP_E_VERSION, "struct_size");
    }
}

// An older program: the struct ends before `field`. Its memory ends there too.
#define SHORTER(valid, field)                                                                                          \
    Bytes(&(valid), offsetof(std::decay_t<decltype(valid)>, field), offsetof(std::decay_t<decltype(valid)>, field), 0) \
        .say(offsetof(std::decay_t<decltype(valid)>, field))

} // namespace

TEST(StructSize, InitFunctions) {
    check_init(init_config, "gp_config");
    check_init(gp_material_init, "gp_material");
    check_init(gp_column_init, "gp_column");
    check_init(gp_plate_init, "gp_plate");
    check_init(gp_output_init, "gp_output");
}

TEST(StructSize, LongerAndTooShortInputs) {
    check_input(make_config(), "gp_config", [](const gp_config *config) {
        gp_sim *sim = nullptr;
        const gp_status status = gp_create(config, &sim);
        EXPECT_EQ(sim == nullptr, status != GP_OK);
        gp_destroy(sim);
        return status;
    });
    Sim sim;
    const auto add = [&](auto call, const auto *given) {
        int32_t id = 99;
        const gp_status status = call(sim, given, &id);
        if (status != GP_OK) {
            EXPECT_EQ(id, 0);
        }
        return status;
    };
    check_input(make_material(), "gp_material", [&](const gp_material *m) { return add(gp_add_material, m); });
    check_input(make_column(2, 2), "gp_column", [&](const gp_column *c) { return add(gp_add_column, c); });
    check_input(make_floor(), "gp_plate", [&](const gp_plate *p) { return add(gp_add_plate, p); });
    EXPECT_EQ(sim.count(), 4 * 5) << "the refused columns were not added";
    if (!has("hdf5"))
        return;
    check_input(make_output(), "gp_output", [&](const gp_output *output) {
        const gp_status status = gp_output_open(sim, (testing::TempDir() + "granperi_struct_size.h5").c_str(), output);
        if (status == GP_OK) {
            EXPECT_EQ(gp_output_close(sim), GP_OK);
        }
        return status;
    });
}

TEST(StructSize, OlderConfigIsCompletedWithDefaults) {
    gp_config config = make_config();
    config.gravity_x = 1;
    gp_sim *handle = nullptr;
    for (std::size_t size = 8; size <= sizeof config; size += 8) {
        gp_config lost = config;
        // What an older program has behind its struct is not ours to read.
        std::memset(reinterpret_cast<char *>(&lost) + size, 0xff, sizeof lost - size);
        Bytes bytes(&lost, size, size, 0);
        ASSERT_EQ(gp_create(bytes.say(size).as<gp_config>(), &handle), GP_OK) << size << ": " << gp_last_error();
        gp_destroy(handle);
    }
    // The spacing is not in it: 0.0025 m by default, so this column has 4 x 4 particles.
    gp_column column = make_column(1, 1);
    Bytes none = SHORTER(config, spacing);
    ASSERT_EQ(gp_create(none.as<gp_config>(), &handle), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_add_column(handle, &column, nullptr), GP_OK);
    gp_particles particles{};
    particles.struct_size = sizeof particles;
    EXPECT_EQ(gp_get_particles(handle, 0, &particles), GP_OK);
    EXPECT_EQ(particles.count, 16);
    gp_destroy(handle);
}

// A program from before bulk_viscosity, the last field, gets the same run as one that leaves it at its default.
TEST(StructSize, OlderConfigGivesTheRunOfTheDefaults) {
    const gp_config config = make_config();
    std::vector<uint64_t> bits[2];
    for (std::size_t k = 0; k < 2; ++k) {
        Bytes old = SHORTER(config, bulk_viscosity);
        Sim sim(k == 0 ? config : make_config());
        if (k == 1) {
            gp_destroy(sim.handle);
            ASSERT_EQ(gp_create(old.as<gp_config>(), &sim.handle), GP_OK) << gp_last_error();
        }
        add_collapse(sim, 6, 5);
        ASSERT_EQ(gp_step(sim, 20), GP_OK) << gp_last_error();
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

// Of the schemes by number density, too, as soon as the struct says that it is one: what it does not know is its preset's.
TEST(StructSize, OlderConfigOfThePaperIsCompletedWithItsPreset) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        gp_config config;
        ASSERT_EQ(gp_config_init(&config, sizeof config, preset), GP_OK);
        config.spacing = spacing;
        std::vector<uint64_t> whole;
        for (std::size_t size = sizeof config; size >= offsetof(gp_config, friction_factor); size -= 8) {
            Bytes bytes(&config, size, size, 0);
            Sim sim;
            gp_destroy(sim.handle);
            ASSERT_EQ(gp_create(bytes.say(size).as<gp_config>(), &sim.handle), GP_OK)
                << size << ": " << gp_last_error();
            add_collapse(sim, 6, 5);
            ASSERT_EQ(gp_step(sim, 5), GP_OK) << gp_last_error();
            if (whole.empty())
                whole = snapshot(sim, 3);
            EXPECT_EQ(snapshot(sim, 3), whole) << "preset " << preset << ", size " << size;
        }
    }
}

TEST(StructSize, OlderSceneStructsAreCompletedWithDefaults) {
    Sim sim;
    const gp_material material = make_material();
    Bytes m = SHORTER(material, i0);
    EXPECT_EQ(gp_add_material(sim, m.as<gp_material>(), nullptr), GP_OK) << gp_last_error();

    const gp_column column = make_column(2, 2);
    Bytes no_material = SHORTER(column, material), no_pressure = SHORTER(column, initial_pressure);
    EXPECT_EQ(gp_add_column(sim, no_material.as<gp_column>(), nullptr), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_add_column(sim, no_pressure.as<gp_column>(), nullptr), GP_OK) << gp_last_error();
    Bytes no_width = SHORTER(column, width);
    EXPECT_FAILS(gp_add_column(sim, no_width.as<gp_column>(), nullptr), GP_E_ARGUMENT, "width");

    const gp_plate plate = make_floor();
    Bytes no_friction = SHORTER(plate, friction), no_load = SHORTER(plate, normal_pressure);
    EXPECT_EQ(gp_add_plate(sim, no_friction.as<gp_plate>(), nullptr), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_add_plate(sim, no_load.as<gp_plate>(), nullptr), GP_OK) << gp_last_error();
    Bytes no_end = SHORTER(plate, x1); // both of its coordinates are 0 then
    EXPECT_EQ(gp_add_plate(sim, no_end.as<gp_plate>(), nullptr), GP_OK) << gp_last_error();

    if (!has("hdf5"))
        return;
    const gp_output output = make_output();
    Bytes no_fields = SHORTER(output, fields);
    const std::string path = testing::TempDir() + "granperi_old_output.h5";
    EXPECT_EQ(gp_output_open(sim, path.c_str(), no_fields.as<gp_output>()), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_output_close(sim), GP_OK);
}

// What the library fills, it fills as far as the caller has room.
TEST(StructSize, OutputsAreNotWrittenPastTheirSize) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(3, 3));
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    const auto check = [&](auto whole, const char *name, const auto &get) {
        SCOPED_TRACE(name);
        using T = decltype(whole);
        for (std::size_t size = 8; size <= sizeof(T); size += 8) {
            Bytes bytes("", 0, sizeof(T) + 32, guard_byte);
            ASSERT_EQ(get(bytes.say(size).template as<T>()), GP_OK) << gp_last_error();
            EXPECT_EQ(bytes.as<T>()->struct_size, size);
            EXPECT_TRUE(bytes.all(size, guard_byte)) << size;
        }
        Bytes longer("", 0, sizeof(T) + 32, guard_byte);
        ASSERT_EQ(get(longer.say(sizeof(T) + 16).template as<T>()), GP_OK) << gp_last_error();
        EXPECT_TRUE(longer.all(sizeof(T) + 16, guard_byte));
        for (const std::size_t size : {0, 1, 4, 7}) {
            Bytes bytes("", 0, sizeof(T), guard_byte);
            EXPECT_FAILS(get(bytes.say(size).template as<T>()), GP_E_ARGUMENT, "struct_size");
            EXPECT_TRUE(bytes.all(4, guard_byte));
        }
    };
    check(gp_state(), "gp_state", [&](gp_state *state) { return gp_get_state(sim, state); });
    check(gp_particles(), "gp_particles", [&](gp_particles *p) { return gp_get_particles(sim, GP_FIELD_ALL, p); });
    using Load = gp_load; // with "()" behind it the name would be the macro
    check(Load(), "gp_load", [&](gp_load *load) { return gp_get_plate_load(sim, 0, load); });

    gp_state old{};
    old.struct_size = offsetof(gp_state, dt);
    old.dt = 77;
    ASSERT_EQ(gp_get_state(sim, &old), GP_OK);
    EXPECT_EQ(old.step, 2);
    EXPECT_EQ(old.dt, 77);
}

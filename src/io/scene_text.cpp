#include "io/scene_text.hpp"

#include "error.hpp"
#include "io/config_names.hpp"
#include "io/material_names.hpp"

namespace gp::io {

namespace {

// Numbers are finite: the scene was checked. 17 digits give the same bits back.
class Object {
public:
    explicit Object(std::string &text) : text_(text) { text_ += '{'; }
    void end() { text_ += '}'; } // not in a destructor: it needs memory

    void key(const char *name) {
        text_ += format_text("%s\"%s\": ", first_ ? "" : ", ", name);
        first_ = false;
    }
    void value(const char *name, double number) {
        key(name);
        text_ += format_text("%.17g", number);
    }
    template <class Integer> void value(const char *name, Integer number) {
        key(name);
        text_ += std::to_string(number);
    }
    void array(const char *name, const std::vector<double> &numbers) {
        key(name);
        text_ += '[';
        for (std::size_t k = 0; k < numbers.size(); ++k)
            text_ += format_text("%s%.17g", k > 0 ? ", " : "", numbers[k]);
        text_ += ']';
    }

private:
    std::string &text_;
    bool first_ = true;
};

void add_material(std::string &text, const gp_material &m) {
    Object object(text);
    for_each_of_material([&](const char *name, auto number) { object.value(name, m.*number); });
    object.end();
}

void add_plate(std::string &text, const PlateSpec &p) {
    // A plate that grows does not compile here: this and checkpoints need its new numbers.
    static_assert(sizeof(gp_plate) == 192);
    Object object(text);
    if (p.points.size() == 2) {
        object.value("x0", p.points[0].x());
        object.value("y0", p.points[0].y());
        object.value("x1", p.points[1].x());
        object.value("y1", p.points[1].y());
    } else {
        std::vector<double> x, y;
        for (const Vector &point : p.points) {
            x.push_back(point.x());
            y.push_back(point.y());
        }
        object.array("point_x", x);
        object.array("point_y", y);
    }
    object.value("friction", p.friction);
    object.value("wall_mu", p.wall_mu);
    object.value("fluidity", p.fluidity);
    object.value("vx", p.motion.velocity.x());
    object.value("vy", p.motion.velocity.y());
    object.value("pivot_x", p.pivot.x());
    object.value("pivot_y", p.pivot.y());
    object.value("omega", p.motion.omega);
    object.value("surface_velocity", p.surface_velocity);
    if (p.start != Vector::Zero() || p.start_angle != 0) { // driven before the first step
        object.value("start_x", p.start.x());
        object.value("start_y", p.start.y());
        object.value("start_angle", p.start_angle);
    }
    if (!p.table.empty()) {
        object.array("knot_t", p.table.t);
        object.array("knot_x", p.table.x);
        object.array("knot_y", p.table.y);
        if (!p.table.angle.empty())
            object.array("knot_angle", p.table.angle);
    }
    object.value("normal_pressure", p.load);
    object.value("mass_per_length", p.mass);
    object.end();
}

template <class Items, class Add> void add_list(std::string &text, const Items &items, const Add &add) {
    text += '[';
    const char *before = "";
    for (const auto &item : items) {
        text += before;
        add(text, item);
        before = ", ";
    }
    text += ']';
}

} // namespace

std::string scene_text(const Scene &scene) {
    std::string text;
    Object all(text);
    all.key("config");
    Object config(text);
    exchange_config(config, scene.config());
    config.end();
    all.key("materials");
    add_list(text, scene.materials(), add_material);
    all.key("columns");
    add_list(text, scene.bodies(), [](std::string &to, const Body &body) { to += std::to_string(body.material); });
    all.key("plates");
    add_list(text, scene.plates(), add_plate);
    all.end();
    return text;
}

} // namespace gp::io

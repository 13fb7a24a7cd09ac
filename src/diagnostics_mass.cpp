// Where the mass lies. Unlike the fronts, which hang on single grains, its marks change with the spacing only as the flow
// does.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnostics.hpp"
#include "parts.hpp"
#include "sort_by_x.hpp"
#include "stretches.hpp"

namespace gp {

namespace {

// The mass left of x, each particle's spread evenly over a spacing: without it the marks of a column would be a quarter
// spacing off on average, and jump from particle to particle.
class MassLeftOf {
public:
    explicit MassLeftOf(const World &world) : spacing_(world.constants.spacing) {
        const Particles &p = world.particles;
        const Period &period = world.constants.period;
        for (int64_t i = 0; i < p.count; ++i) {
            const double mass = world.material_of(i).density * p.volume;
            double x = p.x[i];
            if (period) { // what is beyond one end comes in at the other
                x -= period.shift_of(x);
                for (double shift : {-period.length, period.length})
                    if (std::abs(x + shift - period.x_min - 0.5 * period.length) < 0.5 * (period.length + spacing_))
                        masses_.push_back({x + shift, mass});
            }
            masses_.push_back({x, mass});
        }
        collect(world.crossing, masses_);
        on_first(world, [&] { add_up(period); });
    }

    bool empty() const { return masses_.empty(); }

    // Where `share` of the mass between the ends lies to the left; the middle of a gap.
    double mark(double share) const {
        const double begin = at(left_), all = at(right_) - begin, rounding = 1e-10 * all;
        const double wanted = begin + share * all;
        return 0.5 * (where([&](double mass) { return mass < wanted - rounding; }) +
                      where([&](double mass) { return mass <= wanted + rounding; }));
    }

private:
    struct Mass {
        double x, mass;
    };

    void add_up(const Period &period) {
        if (masses_.empty())
            return;
        sort_by_x(masses_, [](const Mass &a, const Mass &b) { return a.x != b.x ? a.x < b.x : a.mass < b.mass; });
        before_.reserve(masses_.size() + 1);
        before_.push_back(0);
        for (const Mass &m : masses_)
            before_.push_back(before_.back() + m.mass);
        left_ = masses_.front().x - 0.5 * spacing_;
        right_ = masses_.back().x + 0.5 * spacing_;
        if (period) {
            left_ = std::max(left_, period.x_min);
            right_ = std::min(right_, period.x_min + period.length);
        }
    }

    double at(double x) const {
        const auto before = [](const Mass &m, double value) { return m.x < value; };
        auto k = std::lower_bound(masses_.begin(), masses_.end(), x - 0.5 * spacing_, before);
        double sum = before_[std::distance(masses_.begin(), k)];
        for (; k != masses_.end() && k->x < x + 0.5 * spacing_; ++k)
            sum += k->mass * ((x - k->x) / spacing_ + 0.5);
        return sum;
    }

    // Where the mass left of x ceases to be short.
    template <class Short> double where(const Short &is_short) const {
        double low = left_, high = right_;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            (is_short(at(middle)) ? low : high) = middle;
        }
        return high;
    }

    double spacing_, left_ = 0, right_ = 0;
    std::vector<Mass> masses_;   // by x
    std::vector<double> before_; // kg/m, of those before each
};

} // namespace

MassMarks measure_marks(const World &world) {
    MassMarks marks{};
    const MassLeftOf mass(world);
    if (mass.empty())
        return marks;
    for (std::size_t k = 0; k < marks.size(); ++k)
        marks[k] = mass.mark(mass_shares[k]);
    return marks;
}

void CentreSums::add(const World &world) {
    const Particles &p = world.particles;
    if (!begun_ && p.count > 0) {
        first_x_ = p.x[0];
        first_y_ = p.y[0];
        begun_ = true;
    }
    double all = mass_, x = x_, y = y_;
    for (int64_t i = 0; i < p.count; ++i) {
        const double mass = world.material_of(i).density * p.volume;
        all += mass;
        x += mass * (p.x[i] - first_x_);
        y += mass * (p.y[i] - first_y_);
    }
    mass_ = all;
    x_ = x;
    y_ = y;
}

Vector CentreSums::of() const {
    return begun_ ? Vector(first_x_ + x_ / mass_, first_y_ + y_ / mass_) : Vector(0, 0);
}

double detached_share(const World &world, const std::vector<char> &connected) {
    double all = 0, apart = 0;
    for_each_stretch(world, connected, [&](const World &stretch, const char *is_connected) {
        const Particles &p = stretch.particles;
        for (int64_t i = 0; i < p.count; ++i) {
            const double mass = stretch.material_of(i).density * p.volume;
            all += mass;
            apart += is_connected[i] ? 0.0 : mass;
        }
    });
    return all > 0 ? apart / all : 0.0;
}

} // namespace gp

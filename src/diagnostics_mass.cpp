// Where the mass lies. Unlike the fronts, which hang on single grains, its marks change with the spacing only as the flow
// does.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnostics.hpp"
#include "sort_by_x.hpp"

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

    double spacing_, left_, right_;
    std::vector<Mass> masses_;   // by x
    std::vector<double> before_; // kg/m, of those before each
};

} // namespace

MassMarks measure_marks(const World &world) {
    MassMarks marks{};
    if (world.particles.count == 0)
        return marks;
    const MassLeftOf mass(world);
    for (std::size_t k = 0; k < marks.size(); ++k)
        marks[k] = mass.mark(mass_shares[k]);
    return marks;
}

Vector centre_of_mass(const World &world) {
    const Particles &p = world.particles;
    if (p.count == 0)
        return Vector(0, 0);
    double all = 0, x = 0, y = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const double mass = world.material_of(i).density * p.volume;
        all += mass;
        x += mass * (p.x[i] - p.x[0]);
        y += mass * (p.y[i] - p.y[0]);
    }
    return {p.x[0] + x / all, p.y[0] + y / all};
}

double detached_share(const World &world, const std::vector<char> &connected) {
    const Particles &p = world.particles;
    double all = 0, apart = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const double mass = world.material_of(i).density * p.volume;
        all += mass;
        apart += connected[i] ? 0.0 : mass;
    }
    return p.count > 0 ? apart / all : 0.0;
}

} // namespace gp

// The library computes with the floating-point environment that a program starts with: rounding to nearest, gradual
// underflow, no traps. The host's own (flush-to-zero, directed rounding, traps, raised flags) is put aside while the library
// works (entry.hpp). Equal bits ask for it, and lanes that divide 0 by 0 to be discarded.
#pragma once

#include <cfenv>
#include <cstdint>

#ifdef __x86_64__
#include <xmmintrin.h>
#endif

namespace gp {

// The environment of one thread. On x86-64 the loops use SSE alone, whose register is read and written in nanoseconds; the x87
// unit is only looked at, for fesetenv takes a third of a microsecond.
class FloatState {
public:
    void save() {
#ifdef __x86_64__
        sse_ = _mm_getcsr();
        __asm__ volatile("fnstcw %0" : "=m"(x87_control_));
        if (x87_control_ == usual_x87_control)
            return;
#endif
        std::fegetenv(&all_);
    }

    void restore() const {
#ifdef __x86_64__
        if (x87_control_ == usual_x87_control) {
            _mm_setcsr(sse_);
            return;
        }
#endif
        std::fesetenv(&all_);
    }

    // The usual environment in place of the saved one.
    void leave() const {
#ifdef __x86_64__
        if (x87_control_ == usual_x87_control) {
            _mm_setcsr(usual_sse);
            return;
        }
#endif
        std::fesetenv(FE_DFL_ENV);
    }

private:
#ifdef __x86_64__
    static constexpr unsigned usual_sse = 0x1f80;
    static constexpr uint16_t usual_x87_control = 0x37f;
    unsigned sse_ = usual_sse;
    uint16_t x87_control_ = usual_x87_control;
#endif
    std::fenv_t all_;
};

// While it lives, this thread computes in the usual environment. One per thread that shares the work, too: a new thread has
// what the one that made it had set.
class UsualFloats {
public:
    UsualFloats() {
        before_.save();
        before_.leave();
    }
    UsualFloats(const UsualFloats &) = delete;
    UsualFloats &operator=(const UsualFloats &) = delete;
    ~UsualFloats() { before_.restore(); }

private:
    FloatState before_;
};

} // namespace gp

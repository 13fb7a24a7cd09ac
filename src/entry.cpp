#include "entry.hpp"

namespace gp {

namespace {

thread_local Entry *innermost = nullptr;

locale_t plain_locale() {
    static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr); // 0 if there was no memory: the host's stays
    return plain;
}

} // namespace

// None of these is inline: computation is not to be moved past them.
void Entry::leave_host() {
    floats_.save();
    floats_.leave();
    locale_ = uselocale(plain_locale());
}

void Entry::return_to_host() const {
    uselocale(locale_);
    floats_.restore();
}

Entry::Entry() : outer_(innermost) {
    innermost = this;
    leave_host();
}

Entry::~Entry() {
    return_to_host();
    innermost = outer_;
}

BackToHost::BackToHost() {
    if (innermost)
        innermost->return_to_host();
}

BackToHost::~BackToHost() {
    if (innermost)
        innermost->leave_host();
}

} // namespace gp

// What a call of the interface puts aside of the host's thread, and gives back to it at its end and inside callbacks: the
// floating-point environment, and the locale, which has a say in the decimal sign and the words of messages.
#pragma once

#include <locale.h>

#include "float_environment.hpp"

namespace gp {

class Entry {
public:
    Entry();
    Entry(const Entry &) = delete;
    Entry &operator=(const Entry &) = delete;
    ~Entry();

private:
    friend class BackToHost;
    void leave_host();
    void return_to_host() const;

    FloatState floats_;
    locale_t locale_; // of this thread
    Entry *outer_;    // of this thread: a callback may have called
};

// Around a callback. What the callback changes stays changed.
class BackToHost {
public:
    BackToHost();
    BackToHost(const BackToHost &) = delete;
    BackToHost &operator=(const BackToHost &) = delete;
    ~BackToHost();
};

} // namespace gp

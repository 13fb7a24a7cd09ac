// Every way to allocate in this program, so that chosen allocations can fail and those that are left can be counted.
#pragma once

namespace test::memory {

extern bool armed;      // allocations are counted down and fail
extern bool lasting;    // all that follow the failed one fail, too
extern bool everywhere; // those of malloc, of HDF5 for instance, fail, too, not only those of operator new
extern long left;       // allocations before the one that fails
extern bool fired;      // one has failed
extern long failures;   // so far
extern long live;       // blocks, of all
extern long live_new;   // of operator new, so that a leak of the library can be told from one of HDF5

} // namespace test::memory

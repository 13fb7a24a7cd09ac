// The name gp_load for programs that look symbols up: in C it is a type's.
#include "granperi/gp.h"

extern "C" {
GP_API gp_status gp_load_symbol(const char *path, gp_sim **sim) __asm__("gp_load");
gp_status gp_load_symbol(const char *path, gp_sim **sim) {
    return gp_load_file(path, sim);
}
}

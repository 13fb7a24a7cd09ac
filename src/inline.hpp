// For what has to be compiled into its loop, so that the loop is done four at a time.
#pragma once

#define GP_INLINE inline __attribute__((always_inline))

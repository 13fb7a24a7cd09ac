/* A host that calls the library inside its own parallel regions, and between them. Built with the compiler's own OpenMP,
 * which may be another one than the library's. Argument: how many threads the host's regions have. */
#include "scene.h"

#include <omp.h>

int main(int argc, char **argv) {
    const int hosts = argc > 1 ? atoi(argv[1]) : 3;
    const uint64_t alone = run_scene(DEFAULT_SCHEME, 1);
    int round, wrong = 0, regions = 0, largest = 0;
    omp_set_dynamic(0);
    for (round = 0; round < 3; ++round) {
#pragma omp parallel num_threads(hosts) reduction(+ : wrong) reduction(max : largest)
        {
            wrong += run_scene(DEFAULT_SCHEME, 1 + omp_get_thread_num() % 3) != alone;
            largest = omp_get_num_threads();
        }
        wrong += run_scene(DEFAULT_SCHEME, 3) != alone; /* between two regions */
        ++regions;
    }
    require(wrong == 0, "other bits beside the host's regions");
    require(largest == hosts, "the host's region has lost threads");
    require(omp_get_max_threads() >= 1 && !omp_in_parallel(), "the host's OpenMP settings");
    printf("%d regions of %d threads with a simulation in each and one between them: the same bits\n", regions, hosts);
    return 0;
}

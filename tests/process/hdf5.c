/* A host that uses HDF5 itself, serial or (with -DPARALLEL) parallel, in one process with the library's: its open file, its
 * error handler and its identifiers stay as they are, and each of the two writes whole files. usage: hdf5 DIRECTORY */
#include "scene.h"

#include <hdf5.h>

static herr_t quiet(hid_t stack, void *user) {
    (void)stack;
    ++*(int *)user;
    return 0;
}

static hid_t create(const char *path) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    hid_t file;
#ifdef PARALLEL
    H5Pset_fapl_mpio(access, MPI_COMM_SELF, MPI_INFO_NULL);
#endif
    file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    return file;
}

static void write_row(hid_t file, const char *name, double value) {
    const hsize_t size[1] = {3};
    const double row[3] = {value, value + 1, value + 2};
    const hid_t space = H5Screate_simple(1, size, NULL);
    const hid_t data = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    require(data >= 0 && H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, row) >= 0, "the host's HDF5");
    H5Dclose(data);
    H5Sclose(space);
}

static int read_row(hid_t file, const char *name, double row[3]) {
    const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
    const int good = data >= 0 && H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, row) >= 0;
    H5Dclose(data);
    return good;
}

int main(int argc, char **argv) {
    char own[4096], frames[4096], checkpoint[4096];
    int told = 0, k;
    void *user = NULL;
    H5E_auto2_t handler = NULL;
    hid_t file;
    gp_sim *sim, *loaded = NULL;
    double row[3];
    uint64_t hash;
    require(argc == 2 && gp_has_feature("hdf5"), "usage");
#ifdef PARALLEL
    require(MPI_Init(&argc, &argv) == MPI_SUCCESS, "MPI_Init");
#endif
    snprintf(own, sizeof own, "%s/own.h5", argv[1]);
    snprintf(frames, sizeof frames, "%s/frames.h5", argv[1]);
    snprintf(checkpoint, sizeof checkpoint, "%s/checkpoint.gpc", argv[1]);
    H5Eset_auto2(H5E_DEFAULT, quiet, &told);
    file = create(own);
    require(file >= 0, "the host's file");
    sim = make_scene(DEFAULT_SCHEME, 2);
    require(gp_output_open(sim, frames, NULL) == GP_OK, "gp_output_open");
    for (k = 0; k < 3; ++k) {
        char name[20];
        snprintf(name, sizeof name, "row %d", k);
        require(gp_step(sim, 2) == GP_OK && gp_output_write(sim) == GP_OK, "gp_output_write");
        write_row(file, name, k);
        require(gp_save(sim, checkpoint) == GP_OK, "gp_save");
    }
    require(gp_load_file("/nowhere/at all", &loaded) == GP_E_IO && gp_load_file(own, &loaded) == GP_E_IO,
            "what is no checkpoint");
    require(told == 0, "the library's errors reach the host's handler");
    H5Eget_auto2(H5E_DEFAULT, &handler, &user);
    require(handler == quiet && user == &told, "the host's error handler is gone");
    require(H5Fopen("/nowhere/at all", H5F_ACC_RDONLY, H5P_DEFAULT) < 0 && told == 1, "the host's own error");
    /* An HDF5 that is closed underneath the library's open file would take that with it: so first this. */
    hash = fingerprint(sim);
    require(gp_output_close(sim) == GP_OK, "gp_output_close");
    gp_destroy(sim);
    require(read_row(file, "row 2", row) && row[0] == 2 && row[2] == 4, "what the host has written");
    require(H5Fclose(file) >= 0 && H5close() >= 0, "the host's closing");
    /* After the host has closed HDF5 altogether, the library can use it still. */
    require(gp_load_file(checkpoint, &loaded) == GP_OK && fingerprint(loaded) == hash, "gp_load after H5close");
    gp_destroy(loaded);
    file = H5Fopen(frames, H5F_ACC_RDONLY, H5P_DEFAULT);
    require(file >= 0, "the host reads the library's frames");
    H5Fclose(file);
#ifdef PARALLEL
    MPI_Finalize();
#endif
    printf("files of both in turn, the host's handler kept, its %s HDF5 %d.%d.%d\n",
#ifdef PARALLEL
           "parallel",
#else
           "serial",
#endif
           H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE);
    return 0;
}

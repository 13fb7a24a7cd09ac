// A host in another locale, of C and of C++: prints what the library says and writes its files.
// usage: locale DIRECTORY COMMA    COMMA: the decimal sign that the host expects of its own locale
#include "scene.h"

#include <clocale>
#include <locale>
#include <string>

static void in_log(void *, int32_t, const char *text) {
    std::puts(text);
}

static std::string half() {
    char text[8];
    std::snprintf(text, sizeof text, "%.1f", 0.5);
    return text;
}

int main(int argc, char **argv) {
    if (argc != 3)
        return 2;
    std::locale::global(std::locale(""));
    const std::string sign = argv[2], path = std::string(argv[1]) + "/locale";
    require(half() == "0" + sign + "5", "the host's locale is not what the test is about");

    std::printf("%s\n", gp_version_string());
    gp_config config;
    gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT);
    config.spacing = -0.125;
    gp_sim *none = nullptr;
    gp_create(&config, &none);
    std::printf("%s\n", gp_last_error());
    require(std::string(gp_last_error()).find("-0.125") != std::string::npos, "a message without its number");

    gp_sim *sim = make_scene(DEFAULT_SCHEME, 1);
    gp_set_log(sim, in_log, nullptr);
    gp_column thin;
    gp_column_init(&thin, sizeof thin);
    thin.x_min = -0.8;
    thin.width = 0.0311; // to be rounded, which the log says
    thin.height = 0.0051;
    require(gp_add_column(sim, &thin, nullptr) == GP_OK, "gp_add_column");
    if (gp_has_feature("hdf5"))
        require(gp_output_open(sim, (path + ".h5").c_str(), nullptr) == GP_OK, "gp_output_open");
    require(gp_step(sim, 3) == GP_OK, "gp_step");
    if (gp_has_feature("hdf5")) {
        require(gp_output_write(sim) == GP_OK && gp_output_close(sim) == GP_OK, "gp_output_write");
        require(gp_save(sim, (path + ".gpc").c_str()) == GP_OK, "gp_save");
        gp_sim *loaded = nullptr;
        require(gp_load_file((path + ".gpc").c_str(), &loaded) == GP_OK, "gp_load");
        std::printf("loaded %016llx\n", static_cast<unsigned long long>(fingerprint(loaded)));
        gp_destroy(loaded);
        gp_load_file("/nowhere/at all", &loaded);
        std::printf("%s\n", gp_last_error());
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(fingerprint(sim)));
    gp_destroy(sim);
    require(half() == "0" + sign + "5", "the host's locale is changed");
    return 0;
}

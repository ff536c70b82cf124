/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "scatter.h"
#include "exit_code.h"
#include "key_macros.h"
#include "key_reader.h"
#include "memory.h"

#include <string.h>

#define INTO(member) .target = offsetof(gm_flank_scatter, member)
#define AMOUNT       NUMBER(UNIT_UM, BETWEEN(-10000, 10000))
#define SIZE         NUMBER(UNIT_UM, BETWEEN(0, 10000))
#define WAVES        NUMBER(UNIT_SI, BETWEEN(0, 1000))

/* clang-format off */
/* A mean and how it scatters: a gm_scatter_normal at `place` in the struct. */
#define NORMAL_ROWS(section, key, place, text)                                                     \
    {NAME(section, key "_um"), AMOUNT, .target = (place) + offsetof(gm_scatter_normal, mean),      \
     .standard = "0", .help = (text)},                                                             \
    {NAME(section, key "_scatter_um"), SIZE,                                                       \
     .target = (place) + offsetof(gm_scatter_normal, deviation),                                   \
     .standard = "0", .help = "its standard deviation"}

/* A gm_trace_scatter at `place`. */
#define TRACE_ROWS(section, place, slope_text)                                                     \
    NORMAL_ROWS(section, "slope", (place) + offsetof(gm_trace_scatter, slope), slope_text),        \
    NORMAL_ROWS(section, "crowning", (place) + offsetof(gm_trace_scatter, crowning),               \
                "missing at both ends, none in the middle; a parabola"),                           \
    {NAME(section, "wave_least_um"), SIZE, .target = (place) + offsetof(gm_trace_scatter, wave.low), \
     .standard = "0", .help = "amplitude of a wave: any from here"},                               \
    {NAME(section, "wave_most_um"), SIZE, .target = (place) + offsetof(gm_trace_scatter, wave.high), \
     .standard = "0", .help = "to here"},                                                          \
    {NAME(section, "waves_least"), WAVES, .target = (place) + offsetof(gm_trace_scatter, wave_count.low), \
     .standard = "1", .help = "how many such waves there are from end to end: any number from here"}, \
    {NAME(section, "waves_most"), WAVES, .target = (place) + offsetof(gm_trace_scatter, wave_count.high), \
     .standard = "3", .help = "to here"}

static const key_spec keys[] = {
    TRACE_ROWS("profile", offsetof(gm_flank_scatter, profile),
               "material rises so much from the start of the profile to the tip"),
    TRACE_ROWS("helix", offsetof(gm_flank_scatter, helix), "material rises so much from t1 = 0 to 1"),
    NORMAL_ROWS("foot", "material", offsetof(gm_flank_scatter, foot),
                "at the start of the profile, falls linearly to none"),
    {NAME("foot", "end_t2"), NUMBER(UNIT_SI, {0, 1, 1, 0, 0}), INTO(foot_end), .standard = "0.35",
     .help = "where it is none"},
    NORMAL_ROWS("tip", "relief", offsetof(gm_flank_scatter, tip_relief), "missing at the tip, a parabola"),
    {NAME("tip", "start_t2"), NUMBER(UNIT_SI, {0, 1, 0, 1, 0}), INTO(tip_start), .standard = "0.8",
     .help = "where it begins"},
    {NAME("surface", "roughness_um"), SIZE, INTO(roughness), .standard = "0",
     .help = "standard deviation of every node"},
    {NAME("pitch", "scatter_um"), SIZE, INTO(pitch), .standard = "0",
     .help = "standard deviation of the places of the tooth spaces, along the line of action"},
    {NAME("pitch", "eccentricity_um"), SIZE, INTO(eccentricity), .standard = "0",
     .help = "of the gear's axis; the run-out is twice that"},
};
/* clang-format on */

const key_table scatter_keys = {"gearflanks", keys, (int)(sizeof keys / sizeof keys[0]), NULL};

/* A range that ends before it begins is told where it ends. */
static int check_range(const key_reader *reader, const char *section, const char *least,
                       const char *most, const gm_scatter_uniform *range) {
    const int index = key_find(&scatter_keys, section, most);
    const key_entry *entry = &reader->entries[index];

    if (range->low <= range->high) {
        return 0;
    }

    char place[KEY_PLACE_SIZE];
    key_place(place, reader->path, entry->origin, entry->line, keys[index].full_name);
    message_error(reader->messages, "%smust be at least %s (got %s)", place, least,
                  entry->text != NULL ? entry->text : keys[index].standard);
    return 1;
}

static int check_trace(const key_reader *reader, const char *section,
                       const gm_trace_scatter *trace) {
    return check_range(reader, section, "wave_least_um", "wave_most_um", &trace->wave) +
           check_range(reader, section, "waves_least", "waves_most", &trace->wave_count);
}

int scatter_read(scatter_file *file, const char *path, message_sink *messages) {
    memset(file, 0, sizeof *file);
    file->entries = allocate((size_t)scatter_keys.count, sizeof *file->entries);
    if (file->entries == NULL ||
        key_assign_defaults(&scatter_keys, &file->amounts) == KEY_NO_MEMORY) {
        scatter_free(file);
        return message_no_memory(messages);
    }

    key_reader reader = {.table = &scatter_keys,
                         .filled = &file->amounts,
                         .entries = file->entries,
                         .path = path,
                         .messages = messages};
    message_begin(messages, MOST_MESSAGES);
    key_reader_read(&reader);
    if (reader.faults == 0 && !reader.no_memory) {
        reader.faults = check_trace(&reader, "profile", &file->amounts.profile) +
                        check_trace(&reader, "helix", &file->amounts.helix);
    }
    message_end(messages, path);

    if (reader.faults == 0 && !reader.no_memory) {
        return 0;
    }
    scatter_free(file);
    return reader.no_memory ? message_no_memory(messages) : EXIT_BAD_INPUT;
}

void scatter_print(const scatter_file *file, FILE *stream) {
    for (int i = 0; i < scatter_keys.count; ++i) {
        if (file->entries[i].text != NULL) {
            fprintf(stream, "# %s = %s\n", keys[i].full_name, file->entries[i].text);
        }
    }
}

void scatter_free(scatter_file *file) {
    key_entries_free(file->entries, scatter_keys.count);
    file->entries = NULL;
}

/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "key_template.h"
#include "keys.h"

#include <string.h>

/* The choices that decide which keys are used. */
static const char *const deciding[][2] = {
    {"analysis", "type"}, {"drive", "kind"}, {"mesh", "model"}, {"mesh", "law"}};
enum { DECIDING = sizeof deciding / sizeof deciding[0] };

static const key_spec *deciding_key(int which) {
    return &gearsim_keys.keys[key_find(&gearsim_keys, deciding[which][0], deciding[which][1])];
}

/* Makes the choice of this name; returns its key, or NULL after a message. */
static const key_spec *choose(config *conf, const char *kind, message_sink *messages) {
    char fault[KEY_FAULT_SIZE];
    char known[KEY_FAULT_SIZE] = "";

    for (int which = 0; which < DECIDING; ++which) {
        const key_spec *key = deciding_key(which);
        if (key_choice_find(key->choices, kind) >= 0) {
            (void)key_assign(key, conf, kind, fault);
            return key;
        }

        char choices[80];
        key_choices_print(key->choices, choices, sizeof choices);
        strcat(strcat(known, which > 0 ? " | " : ""), choices);
    }
    message_of_program(messages, "--template: must be %s, or nothing (got '%.80s')", known, kind);
    return NULL;
}

/* Lines as comments, without their indentation. */
static void print_comment(const char *lines, FILE *stream) {
    while (*lines != '\0') {
        lines += strspn(lines, " ");
        const size_t length = strcspn(lines, "\n") + 1;
        fprintf(stream, "; %.*s", (int)length, lines);
        lines += length;
    }
}

/* The keys that the choices use, or all of them with those commented out that are not used. */
static void print_keys(const config *conf, const key_spec *chosen, const char *kind, FILE *stream) {
    const char *section = "";
    const char *reason;

    for (int i = 0; i < gearsim_keys.count; ++i) {
        const key_spec *key = &gearsim_keys.keys[i];
        const int is_used = key_is_used(key, conf, &reason);
        if (key->family_member != 0 || (chosen != NULL && !is_used)) {
            continue;
        }

        if (strcmp(key->section, section) != 0) {
            section = key->section;
            fprintf(stream, "\n[%s]\n", section);
        }
        if (key->family != NULL && gearsim_keys.keys[i - 1].family == NULL) {
            print_comment(gearsim_keys.legend, stream);
        }
        key_print_line(key, key == chosen ? kind : is_used ? key->example : NULL, stream);
    }
}

int key_template_print(const char *kind, FILE *stream, message_sink *messages) {
    config conf;
    memset(&conf, 0, sizeof conf);
    if (key_assign_defaults(&gearsim_keys, &conf) != KEY_TAKEN) {
        config_free(&conf);
        return message_no_memory(messages);
    }
    conf.law = LAW_CONSTANT; /* the example has a stiffness */

    const key_spec *chosen = kind != NULL ? choose(&conf, kind, messages) : NULL;
    const int status = kind == NULL || chosen != NULL ? EXIT_DONE : EXIT_BAD_INPUT;
    if (status == EXIT_DONE) {
        fprintf(stream, "; Parameters of gearsim: %s%s.\n",
                kind != NULL ? "the keys for " : "all keys", kind != NULL ? kind : "");
        fputs("; Values that are not commented out are an example that runs: put your own in their "
              "place.\n"
              "; The others stand there with their default, or say what happens without them.\n"
              "; `gearsim --help` lists all keys with their ranges.\n",
              stream);
        print_keys(&conf, chosen, kind, stream);
    }
    config_free(&conf);
    return status;
}

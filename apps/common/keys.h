/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The keys of gearsim's INI file, and which of them a configuration uses. */
#ifndef APPS_KEYS_H
#define APPS_KEYS_H

#include "config.h"
#include "key_table.h"

/* Fills a config. */
extern const key_table gearsim_keys;

/* Does the configuration use the key? If not, `reason` is the choice that makes it unused. */
int key_is_used(const key_spec *key, const config *conf, const char **reason);
int key_is_required(const key_spec *key, const config *conf);

#endif

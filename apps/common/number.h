/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Numbers as text, the same as printf("%.*g") but several times faster: writing numbers would
 * otherwise cost as much as computing them. And which texts are numbers.
 */
#ifndef APPS_NUMBER_H
#define APPS_NUMBER_H

/* Room for a text, which is written in whole words: more than the longest one takes. */
enum { NUMBER_TEXT_SIZE = 48 };

/* Writes `value` with 1 to 17 significant digits, '\0' at the end. Returns the length of the text. */
int number_format(char text[NUMBER_TEXT_SIZE], double value, int digits);

/* Whether a text is a plain decimal number, with or without exponent, and nothing else. */
int number_is_plain(const char *text);

#endif

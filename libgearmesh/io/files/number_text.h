/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file number_text.h
 * Numbers in files: strict, the same in every locale, and exact there and back.
 *
 * Units change in the text, not in the number: 12.5 um is read as the double nearest to 12.5e-6 m, and
 * written from it as 12.5. Hence a file that is read, written and read again gives the same bits.
 */
#ifndef GEARMESH_NUMBER_TEXT_H
#define GEARMESH_NUMBER_TEXT_H

/** Longest number that is read. */
#define GMI_NUMBER_LENGTH 1000

/** Room for the text of any double. */
#define GMI_NUMBER_SIZE 40

enum gmi_number_status {
    GMI_NUMBER_OK = 0,
    GMI_NUMBER_WRONG = 1,    /**< not a plain decimal or exponent notation */
    GMI_NUMBER_TOO_LARGE = 2 /**< beyond the range of a double */
};

/**
 * Reads a number that fills the whole text: [+-] digits [. digits] [e [+-] digits], nothing else.
 *
 * @param[in]  text      at most GMI_NUMBER_LENGTH characters; longer ones are wrong
 * @param[in]  exponent  the number is multiplied by 10^exponent, without a rounding of its own
 * @param[out] value     correctly rounded; unchanged on an error
 */
int gmi_number_parse(const char *text, int exponent, double *value);

/**
 * Reads a number at the beginning of a text if it is a plain one: [+-] digits [. digits], 15 digits at most.
 *
 * @param[in]  exponent  as above, <= 7
 * @param[out] value     the same bits as those of gmi_number_parse(); unchanged if NULL is returned
 * @return what follows it, whatever that is; NULL if it is no such number
 */
const char *gmi_number_short(const char *text, int exponent, double *value);

/**
 * Writes a finite number times 10^exponent.
 *
 * @param[in] digits  significant digits; 0 = the fewest from 15 on that give the same double back
 * @return text
 */
const char *gmi_number_text(char text[GMI_NUMBER_SIZE], double value, int exponent, int digits);

#endif /* GEARMESH_NUMBER_TEXT_H */

/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elimination and substitution from element to element: the part of elastic_front.c that is compiled twice, unrolled for
 * usual numbers of lines and as loops for any. Before it is included:
 *
 *     ELASTIC_NAME(name)   the name of a function
 *     UNROLLED             in front of a loop that is to be unrolled, or nothing
 */

/*
 * From the station at the begin of an element to that at its end, from element to element as long as they are alike. carry
 * [left + 1][left + 2], its upper half with the right-hand side behind: what the stations before leave; afterwards the
 * same one station further. front: [unknowns][unknowns + 1].
 */
SPECIALIZED void ELASTIC_NAME(step)(traffic t, front_state *f, int from, int to, double *front) {
    const gmi_elastic_work *work = f->work;
    const gmi_elastic_layer *tooth = &f->law->tooth, *rim_layer = &f->law->rim;
    double *record = f->record, *carry = work->carry;
    double fall = f->fall;
    const int left = left_lines(t), right = right_lines(t);
    const int first = left + 1, all = left + right + 2, width = all + 1;
    const int rim_left = left, rim_right = all - 1;

    /* Where the numbers of each line are, by element or station: lines that end, go through, begin. */
    const ptrdiff_t n = work->stations, size = work->slots;
    const int low = work->low[from], begin = work->high[from] + 1 - t.beginning;
    const double *slots[2 * UNKNOWNS_MAX] = {NULL};
    double *sides[2 * UNKNOWNS_MAX] = {NULL};
    UNROLLED for (int i = 0; i < left; ++i) {
        slots[i] = slots_of(work, low + i);
        sides[i] = f->rows + (low + i) * n;
    }
    UNROLLED for (int i = 0; i < t.beginning; ++i) {
        slots[left + i] = slots_of(work, begin + i);
        sides[left + i] = f->rows + (begin + i) * n;
    }
    double *rim_side = f->rows + work->lines_max * n;
    int *record_of = work->factor_at;

    for (ptrdiff_t e = from; e <= to; ++e) {
        record_of[e] = (int)(record - work->factor);

        /* What is left of the stations before, and nothing yet of the right one. */
        UNROLLED for (int i = 0; i < first; ++i) {
            UNROLLED for (int k = i; k < first; ++k) {
                front[i * width + k] = carry[i * (first + 1) + k];
            }
            UNROLLED for (int k = first; k < all; ++k) {
                front[i * width + k] = 0.0;
            }
            front[i * width + all] = carry[i * (first + 1) + first];
        }
        UNROLLED for (int i = first; i < all; ++i) {
            UNROLLED for (int k = i; k < all; ++k) {
                front[i * width + k] = 0.0;
            }
        }
        const double beside = tooth->beside[e], diagonal = tooth->diagonal[e + 1];
        const double *rim_diagonal = e + 1 == work->end ? rim_layer->right : rim_layer->diagonal;
        rim_part rim = {0.0, rim_layer->beside[e], rim_diagonal[e + 1]};

        /* Lines that end: their right station goes here. */
        UNROLLED for (int i = 0; i < t.ending; ++i) {
            part p = part_of(slots[i] + e, size, beside, &rim);
            double *side = sides[i] + e;
            end_row *r = end_row_of(work, low + i);
            p.right += tooth->right[e + 1];
            take_end(&p, &rim, r);
            fall += side[1] * side[1] * r->inverse;
            front[i * width + i] += p.left;
            front[i * width + rim_left] += p.left_left;
            front[i * width + rim_right] = p.left_right;
            forward_end(r, &side[1], &front[i * width + all], rim_side + e,
                        &front[rim_left * width + all]);
        }

        /* Lines that go through. */
        UNROLLED for (int j = 0; j < t.through; ++j) {
            const int i = t.ending + j, k = first + j;
            const part p = part_of(slots[i] + e, size, beside, &rim);
            front[i * width + i] += p.left;
            front[i * width + rim_left] += p.left_left;
            front[i * width + k] = p.cross;
            front[i * width + rim_right] = p.left_right;
            front[rim_left * width + k] = p.right_left;
            front[k * width + k] = p.right + diagonal;
            front[k * width + rim_right] = p.right_right;
            front[k * width + all] = sides[i][e + 1];
        }

        /* Lines of this element alone. */
        for (int row = low + left; row < begin; ++row) {
            double *side = f->rows + row * n + e;
            double *rim_before = &front[rim_left * width + all];
            take_both(f->law, work, (int)e, row, &rim, side, &fall);
            forward_end(begin_row(work, row), &side[0], &side[1], rim_side + e, rim_before);
            forward_end(end_row_of(work, row), &side[1], &side[0], rim_side + e, rim_before);
        }

        /* Lines that begin: their left station goes here. */
        UNROLLED for (int j = 0; j < t.beginning; ++j) {
            const int k = first + t.through + j;
            part p = part_of(slots[left + j] + e, size, beside, &rim);
            double *side = sides[left + j] + e;
            end_row *r = begin_row(work, begin + j);
            p.left += tooth->left[e];
            take_begin(&p, &rim, r);
            fall += side[0] * side[0] * r->inverse;
            front[rim_left * width + k] = p.right_left;
            front[k * width + k] = p.right + diagonal;
            front[k * width + rim_right] = p.right_right;
            front[k * width + all] = side[1];
            forward_end(r, &side[0], &front[k * width + all], rim_side + e,
                        &front[rim_left * width + all]);
        }
        front[rim_left * width + rim_left] += rim.left;
        front[rim_left * width + rim_right] = rim.cross;
        front[rim_right * width + rim_right] = rim.right;
        front[rim_right * width + all] = rim_side[e + 1];

        /* The left station goes. */
        UNROLLED for (int j = 0; j < first; ++j) {
            const double inverse = 1.0 / front[j * width + j];
            const double value = front[j * width + all] * inverse;
            *record++ = inverse;
            UNROLLED for (int k = j + 1; k < all; ++k) {
                if (is_empty(t, j, k)) {
                    continue;
                }
                const double factor = front[j * width + k] * inverse;
                *record++ = factor;
                UNROLLED for (int c = k; c < width; ++c) {
                    if (!is_empty(t, j, c)) {
                        front[k * width + c] -= factor * front[j * width + c];
                    }
                }
            }
            fall += front[j * width + all] * value;
            *(j < left ? sides[j] + e : rim_side + e) = value;
        }
        UNROLLED for (int i = first; i < all; ++i) {
            UNROLLED for (int k = i; k < width; ++k) {
                carry[(i - first) * (right + 2) + k - first] = front[i * width + k];
            }
        }
    }
    f->record = record;
    f->fall = fall;
}

/* Where the rows of the lines of an element are: those of its left station, then those that begin. */
SPECIALIZED void ELASTIC_NAME(find_rows)(traffic t, const gmi_elastic_work *work, int element,
                                         double *rows, double **row) {
    const ptrdiff_t n = work->stations;
    const int left = left_lines(t);
    UNROLLED for (int i = 0; i < left; ++i) {
        row[i] = rows + (work->low[element] + i) * n;
    }
    UNROLLED for (int i = 0; i < t.beginning; ++i) {
        row[left + i] = rows + (work->high[element] + 1 - t.beginning + i) * n;
    }
}

/* One more right-hand side from the left station to the right one, as in step(). */
SPECIALIZED void ELASTIC_NAME(forward)(traffic t, const gmi_elastic_work *work, int from, int to,
                                       double *rows) {
    const int left = left_lines(t), first = left + 1, all = left + right_lines(t) + 2;
    const int low = work->low[from], begin = work->high[from] + 1 - t.beginning;
    double *rim = rows + work->lines_max * work->stations;
    double *row[2 * UNKNOWNS_MAX] = {NULL}, values[2 * UNKNOWNS_MAX];
    ELASTIC_NAME(find_rows)(t, work, from, rows, row);
    const double *record = work->factor + work->factor_at[from];
    for (ptrdiff_t e = from; e <= to; ++e) {
        UNROLLED for (int i = 0; i < t.ending; ++i) {
            forward_end(end_row_of(work, low + i), &row[i][e + 1], &row[i][e], rim + e, rim + e);
        }
        for (int k = low + left; k < begin; ++k) {
            double *at = rows + k * (ptrdiff_t)work->stations + e;
            forward_end(begin_row(work, k), &at[0], &at[1], rim + e, rim + e);
            forward_end(end_row_of(work, k), &at[1], &at[0], rim + e, rim + e);
        }
        UNROLLED for (int i = 0; i < t.beginning; ++i) {
            double *at = row[left + i] + e;
            forward_end(begin_row(work, begin + i), &at[0], &at[1], rim + e, rim + e);
        }

        UNROLLED for (int i = 0; i < left; ++i) {
            values[i] = row[i][e];
        }
        values[left] = rim[e];
        UNROLLED for (int i = first; i < all - 1; ++i) {
            values[i] = row[t.ending + i - first][e + 1];
        }
        values[all - 1] = rim[e + 1];
        UNROLLED for (int j = 0; j < first; ++j) {
            const double value = values[j];
            values[j] = value * *record++;
            UNROLLED for (int k = j + 1; k < all; ++k) {
                if (!is_empty(t, j, k)) {
                    values[k] -= *record++ * value;
                }
            }
        }
        UNROLLED for (int i = 0; i < left; ++i) {
            row[i][e] = values[i];
        }
        rim[e] = values[left];
        UNROLLED for (int i = first; i < all - 1; ++i) {
            row[t.ending + i - first][e + 1] = values[i];
        }
        rim[e + 1] = values[all - 1];
    }
}

/* The left station from the right one, which is solved. */
SPECIALIZED void ELASTIC_NAME(back)(traffic t, const gmi_elastic_work *work, int from, int to,
                                    double *rows) {
    const int left = left_lines(t), first = left + 1, all = left + right_lines(t) + 2;
    const int low = work->low[from], begin = work->high[from] + 1 - t.beginning;
    double *rim = rows + work->lines_max * work->stations;
    double *row[2 * UNKNOWNS_MAX] = {NULL}, values[2 * UNKNOWNS_MAX];
    ELASTIC_NAME(find_rows)(t, work, from, rows, row);
    const double *record = work->factor + work->factor_at[to + 1];
    for (ptrdiff_t e = to; e >= from; --e) {
        UNROLLED for (int i = 0; i < left; ++i) {
            values[i] = row[i][e];
        }
        values[left] = rim[e];
        UNROLLED for (int i = first; i < all - 1; ++i) {
            values[i] = row[t.ending + i - first][e + 1];
        }
        values[all - 1] = rim[e + 1];
        UNROLLED for (int j = first - 1; j >= 0; --j) {
            double value = values[j];
            UNROLLED for (int k = all - 1; k > j; --k) {
                if (!is_empty(t, j, k)) {
                    value -= *--record * values[k];
                }
            }
            --record;
            values[j] = value;
        }
        UNROLLED for (int i = 0; i < left; ++i) {
            row[i][e] = values[i];
        }
        rim[e] = values[left];

        /* Ends of lines, the last one first. */
        UNROLLED for (int i = 0; i < t.ending; ++i) {
            back_end(end_row_of(work, low + i), &row[i][e + 1], values[i], rim + e);
        }
        for (int k = low + left; k < begin; ++k) {
            double *at = rows + k * (ptrdiff_t)work->stations + e;
            back_end(end_row_of(work, k), &at[1], 0.0, rim + e);
            back_end(begin_row(work, k), &at[0], at[1], rim + e);
        }
        UNROLLED for (int i = 0; i < t.beginning; ++i) {
            double *at = row[left + i] + e;
            back_end(begin_row(work, begin + i), &at[0], at[1], rim + e);
        }
    }
}

#undef ELASTIC_NAME
#undef UNROLLED

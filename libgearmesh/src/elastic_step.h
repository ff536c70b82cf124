/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elimination and substitution from element to element: the part of elastic_front.c that is compiled twice, unrolled for
 * usual numbers of lines and as loops for any. Before it is included:
 *
 *     ELASTIC_NAME(name)   the name of a function
 *     UNROLLED             in front of a loop that is to be unrolled, or nothing
 */

/* One row over the unknowns of the right station: line `line` has `own`; rim and right-hand side behind all lines. */
SPECIALIZED void ELASTIC_NAME(set_row)(double *row, int unknowns, double none, int line, double own,
                                       double rim, double side) {
    double values[ROW_MAX];
    UNROLLED for (int k = 0; k < row_size(unknowns); ++k) {
        values[k] = k == line ? own : k == unknowns - 1 ? rim : k == unknowns ? side : none;
    }
    UNROLLED for (int k = 0; k < row_size(unknowns); k += LANES) {
        pack(row + k, values + k);
    }
}

/* row -= factor * other, from column `from` on */
SPECIALIZED void ELASTIC_NAME(take_row)(double *row, double factor, const double *other, int from,
                                        int size) {
    UNROLLED for (int k = from & -LANES; k < size; k += LANES) {
        take_part(row + k, factor, other + k);
    }
}

/*
 * From the station at the begin of an element to that at its end, from element to element as long as they are alike. carry
 * [left + 1][row size]: the upper half of what the stations before leave, with the right-hand side behind; afterwards the
 * same one station further. front: work->front, or as large as these elements need.
 */
SPECIALIZED void ELASTIC_NAME(step)(traffic t, front_state *f, gmi_elastic_run *run,
                                    double *front) {
    const gmi_elastic_work *work = f->work;
    const gmi_elastic_layer *tooth = &f->law->tooth, *rim_layer = &f->law->rim;
    double *record = f->record, *carry = work->carry;
    double fall = f->fall;

    /* Unknowns of both stations, the rim's behind those of the lines; what they have with those of the right one. */
    const int left = left_lines(t), first = left + 1, next = right_lines(t) + 1;
    const int carried = row_size(first), size = row_size(next), side_at = next;
    double *own = front, *cross = own + first * first, *ahead = cross + first * size;

    /* Where the numbers of each line are, by element or station: lines that end, go through, begin. */
    const ptrdiff_t n = work->stations, slots_size = work->slots;
    const int low = run->low, begin = low + left + t.alone;
    const double none = work->none;
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
    run->record = (int)(record - work->factor);

    const ptrdiff_t last_element = run->last;
    for (ptrdiff_t e = run->first; e <= last_element; ++e) {
        /* What is left of the stations before. */
        double held[UNKNOWNS_MAX], of_rim[ROW_MAX];
        UNROLLED for (int k = 0; k < size; ++k) {
            of_rim[k] = none;
        }
        UNROLLED for (int i = 0; i < first; ++i) {
            UNROLLED for (int k = i; k < first; ++k) {
                own[i * first + k] = carry[i * carried + k];
            }
            held[i] = carry[i * carried + first];
        }
        const double beside = tooth->beside[e], diagonal = tooth->diagonal[e + 1];
        const double *rim_diagonal = e + 1 == work->end ? rim_layer->right : rim_layer->diagonal;
        rim_part rim = {0.0, rim_layer->beside[e], rim_diagonal[e + 1]};

        /* Lines that end: their right station goes here. */
        UNROLLED for (int i = 0; i < t.ending; ++i) {
            part p = part_of(slots[i] + e, slots_size, beside, &rim);
            double *side = sides[i] + e;
            end_row *r = end_row_of(work, low + i);
            p.right += tooth->right[e + 1];
            take_end(&p, &rim, r);
            fall += side[1] * side[1] * r->inverse;
            own[i * first + i] += p.left;
            own[i * first + left] += p.left_left;
            forward_end(r, &side[1], &held[i], rim_side + e, &held[left]);
            ELASTIC_NAME(set_row)(cross + i * size, next, none, -1, none, p.left_right, held[i]);
        }

        /* Lines that go through. */
        UNROLLED for (int j = 0; j < t.through; ++j) {
            const int i = t.ending + j;
            const part p = part_of(slots[i] + e, slots_size, beside, &rim);
            own[i * first + i] += p.left;
            own[i * first + left] += p.left_left;
            of_rim[j] = p.right_left;
            ELASTIC_NAME(set_row)(cross + i * size, next, none, j, p.cross, p.left_right, held[i]);
            ELASTIC_NAME(set_row)
            (ahead + j * size, next, none, j, p.right + diagonal, p.right_right, sides[i][e + 1]);
        }

        /* Lines of this element alone. */
        for (int row = low + left; row < begin; ++row) {
            double *side = f->rows + row * n + e;
            take_both(f->law, work, (int)e, row, &rim, side, &fall);
            forward_end(begin_row(work, row), &side[0], &side[1], rim_side + e, &held[left]);
            forward_end(end_row_of(work, row), &side[1], &side[0], rim_side + e, &held[left]);
        }

        /* Lines that begin: their left station goes here. */
        UNROLLED for (int j = 0; j < t.beginning; ++j) {
            const int k = t.through + j;
            part p = part_of(slots[left + j] + e, slots_size, beside, &rim);
            double *side = sides[left + j] + e;
            double onward = side[1];
            end_row *r = begin_row(work, begin + j);
            p.left += tooth->left[e];
            take_begin(&p, &rim, r);
            fall += side[0] * side[0] * r->inverse;
            of_rim[k] = p.right_left;
            forward_end(r, &side[0], &onward, rim_side + e, &held[left]);
            ELASTIC_NAME(set_row)
            (ahead + k * size, next, none, k, p.right + diagonal, p.right_right, onward);
        }

        /* The rim. */
        own[left * first + left] += rim.left;
        of_rim[next - 1] = rim.cross;
        of_rim[side_at] = held[left];
        UNROLLED for (int k = 0; k < size; k += LANES) {
            pack(cross + left * size + k, of_rim + k);
        }
        ELASTIC_NAME(set_row)
        (ahead + (next - 1) * size, next, none, -1, none, rim.right, rim_side[e + 1]);

        /* The left station goes: rows over what is left of it, and over the right one. */
        UNROLLED for (int j = 0; j < first; ++j) {
            const double *row = cross + j * size;
            const double inverse = 1.0 / own[j * first + j];
            *record++ = inverse;
            UNROLLED for (int k = j + 1; k < first; ++k) {
                const double factor = own[j * first + k] * inverse;
                *record++ = factor;
                UNROLLED for (int c = k; c < first; ++c) {
                    own[k * first + c] -= factor * own[j * first + c];
                }
                ELASTIC_NAME(take_row)(cross + k * size, factor, row, 0, size);
            }
            UNROLLED for (int k = 0; k < size; k += LANES) {
                scale_part(record + k, inverse, row + k);
            }
            UNROLLED for (int k = 0; k < next; ++k) {
                if (!is_empty(t, j, k)) {
                    ELASTIC_NAME(take_row)(ahead + k * size, record[k], row, k, size);
                }
            }
            const double value = record[side_at];
            fall += row[side_at] * value;
            *(j < left ? sides[j] + e : rim_side + e) = value;
            record += size;
        }
        UNROLLED for (int k = 0; k < next * size; k += LANES) {
            copy_part(carry + k, ahead + k);
        }
    }
    f->record = record;
    f->fall = fall;
}

/* Where the rows of the lines of an element are: those of its left station, then those that begin. */
SPECIALIZED void ELASTIC_NAME(find_rows)(traffic t, const gmi_elastic_work *work, int low,
                                         double *rows, double **row) {
    const ptrdiff_t n = work->stations;
    const int left = left_lines(t);
    UNROLLED for (int i = 0; i < left; ++i) {
        row[i] = rows + (low + i) * n;
    }
    UNROLLED for (int i = 0; i < t.beginning; ++i) {
        row[left + i] = rows + (low + left + t.alone + i) * n;
    }
}

/* One more right-hand side from the left station to the right one, as in step(). */
SPECIALIZED void ELASTIC_NAME(forward)(traffic t, const gmi_elastic_work *work,
                                       const gmi_elastic_run *run, double *rows) {
    const int left = left_lines(t), first = left + 1, all = left + right_lines(t) + 2;
    const int size = row_size(right_lines(t) + 1);
    const int low = run->low, begin = low + left + t.alone;
    double *rim = rows + work->lines_max * work->stations;
    double *row[2 * UNKNOWNS_MAX] = {NULL}, values[2 * UNKNOWNS_MAX];
    ELASTIC_NAME(find_rows)(t, work, low, rows, row);
    const double *record = work->factor + run->record;
    const ptrdiff_t last_element = run->last;
    for (ptrdiff_t e = run->first; e <= last_element; ++e) {
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
            UNROLLED for (int k = j + 1; k < first; ++k) {
                values[k] -= *record++ * value;
            }
            UNROLLED for (int k = first; k < all; ++k) {
                if (!is_empty(t, j, k - first)) {
                    values[k] -= record[k - first] * value;
                }
            }
            record += size;
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
SPECIALIZED void ELASTIC_NAME(back)(traffic t, const gmi_elastic_work *work,
                                    const gmi_elastic_run *run, double *rows) {
    const int left = left_lines(t), first = left + 1, all = left + right_lines(t) + 2;
    const int size = row_size(right_lines(t) + 1);
    const int low = run->low, begin = low + left + t.alone;
    double *rim = rows + work->lines_max * work->stations;
    double *row[2 * UNKNOWNS_MAX] = {NULL}, values[2 * UNKNOWNS_MAX];
    ELASTIC_NAME(find_rows)(t, work, low, rows, row);
    const int record_size = first * size + first * (first + 1) / 2;
    const double *record = work->factor + run->record + (run->last - run->first + 1) * record_size;
    const ptrdiff_t first_element = run->first;
    for (ptrdiff_t e = run->last; e >= first_element; --e) {
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
            record -= size;
            UNROLLED for (int k = all - 1; k >= first; --k) {
                if (!is_empty(t, j, k - first)) {
                    value -= record[k - first] * values[k];
                }
            }
            UNROLLED for (int k = left; k > j; --k) {
                value -= *--record * values[k];
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

# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the pictures of scripts/flanks share beside style.gp.

load 'style.gp'

# From blue (material missing) over grey to red (material added): equal steps of CIELAB lightness, 32 at both ends
# and 96 in the middle. A grey print loses the sign only, which the contour lines tell (dashed: missing).
set palette defined (-6 '#004998', -5 '#0165ba', -4 '#0483db', -3 '#54a0e7', -2 '#86bdf1', -1 '#b8d9f7', 0 '#f3f3f3', \
                     1 '#f3ceb7', 2 '#e7ab89', 3 '#d78761', 4 '#c6643e', 5 '#b23d20', 6 '#9c0006')
drive_colour = '#0072b2'
coast_colour = '#d55e00'

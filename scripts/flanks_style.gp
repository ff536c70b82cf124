# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the pictures of scripts/flanks share.

# From blue (material missing) over grey to red (material added): equal steps of CIELAB lightness, 32 at both ends
# and 96 in the middle. A grey print loses the sign only, which the contour lines tell (dashed: missing).
set palette defined (-6 '#004998', -5 '#0165ba', -4 '#0483db', -3 '#54a0e7', -2 '#86bdf1', -1 '#b8d9f7', 0 '#f3f3f3', \
                     1 '#f3ceb7', 2 '#e7ab89', 3 '#d78761', 4 '#c6643e', 5 '#b23d20', 6 '#9c0006')
drive_colour = '#0072b2'
coast_colour = '#d55e00'
grey = '#606060'
um = ' / µm'

set encoding utf8
set border lw 1.2
set tics out nomirror


# terminal = sprintf(...) of both formats for a picture of so many pixels
terminal(format, name, width, height) = format eq 'png' \
    ? sprintf("set terminal pngcairo size %d,%d font 'DejaVu Sans,13' fontscale 1.25", width, height) \
    : sprintf("set terminal svg size %d,%d font 'DejaVu Sans,13' background '#ffffff' name 'flanks_%s'", \
              width * 0.8, height * 0.8, name)

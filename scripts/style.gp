# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What all pictures share.

# Equal steps of CIELAB lightness, from 5 to 97: equal steps of a value look equal, and their order survives a grey
# print and any colour vision. Reversed: 'set palette @palette_of_steps negative'.
palette_of_steps = "defined (0 '#090f28', 1 '#181d47', 2 '#342764', 3 '#553179', 4 '#863180', 5 '#b0367d', \
    6 '#d44473', 7 '#ec5e61', 8 '#f78052', 9 '#f6a44e', 10 '#fdc15d', 11 '#ffdd85', 12 '#fff7cf')"
grey = '#606060'

# Curves: told apart with any colour vision, and by their dashes.
pinion_colour = '#0072b2'
wheel_colour = '#d55e00'
hunting_colour = '#009e73'
array curve_colours[7] = ['#0072b2', '#d55e00', '#009e73', '#aa4499', '#56b4e9', '#8a6d00', '#000000']
colour_of(i) = curve_colours[i % 7 + 1]
dash_of(i) = i / 7 + 1
um = ' / µm'

set encoding utf8
set border lw 1.2
set tics out nomirror format '%g'

# eval terminal(...): of each format, of so many pixels of the png
if (!exists('formats')) { formats = 'png svg pdf' } # scripts/gnuplot.py says which
terminal(format, name, width, height) = format eq 'png' \
    ? sprintf("set terminal pngcairo size %d,%d font 'DejaVu Sans,13' fontscale 1.25", width, height) \
    : format eq 'pdf' \
    ? sprintf("set terminal pdfcairo size %f,%f font 'DejaVu Sans,13' fontscale 1.0 linewidth 1.5", width / 100.0, height / 100.0) \
    : sprintf("set terminal svg size %d,%d font 'DejaVu Sans,13' fontscale 1.33 background '#ffffff' name '%s'", \
              width * 0.8, height * 0.8, name)

# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Spectrum of the force at one speed, lines by name above it; scripts/plot sets the variables.

load 'style.gp'

set lmargin at screen 0.105
set rmargin at screen 0.965
set tmargin at screen 0.76
set bmargin at screen 0.13
set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set logscale y
set xrange [0:edge]
set yrange [low:high]
set mxtics 5
set xlabel 'frequency / Hz'
set ylabel 'contact force, peak amplitude / N'
set label title_text at screen 0.025, screen 0.955 left font ',17' noenhanced
set label subtitle_text at screen 0.025, screen 0.90 left font ',12' textcolor rgb grey noenhanced
load 'rim.gp'
if (eigenfrequency > 0 && eigenfrequency < edge) {
    set arrow from first eigenfrequency, graph 0 to first eigenfrequency, graph 1 nohead lw 1.2 dt (8,5) lc rgb '#909090'
    set label sprintf('dashed: eigenfrequency f0 = %.5g Hz', eigenfrequency) at screen 0.985, screen 0.02 right \
        font ',10' textcolor rgb grey
}
unset key

do for [format in formats] {
    eval terminal(format, 'plot_spectrum', 1400, 800)
    set output picture . '.' . format
    plot 'spectrum.dat' using 1:2 with lines lw 1.2 lc rgb '#303030'
    unset output
}

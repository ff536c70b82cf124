# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Where the energy of two stages goes, and at which frequencies their teeth mesh:
#     two_stage stages.txt && gnuplot -e "data='stages.txt'; picture='stages.png'" two_stage.gp
set terminal pngcairo size 1200,900
set output picture
set multiplot layout 2,1
set xlabel "time (s)"
set ylabel "energy (mJ)"
set key below
set format y "%g"
set xrange [0.3:0.35]
plot data index 0 using 1:(1e3*$4) with lines linewidth 4 linecolor rgb "gray80" title "in less out", \
     data index 0 using 1:(1e3*$5) with lines title "lost in dampers", \
     data index 0 using 1:(1e3*$6) with lines title "kinetic and stored", \
     data index 0 using 1:(1e3*($4-$5-$6)) with lines title "open"

# Teeth and speed of the shafts tell the lines.
stage_1 = 150.0 * 23 / (2 * pi)
stage_2 = stage_1 / 61 * 19
set xlabel "frequency (Hz)"
set ylabel "force along the line of action (N)"
set logscale y
set format y "10^{%L}"
set xrange [0:2500]
do for [k=1:14] { set arrow from stage_2 * k, graph 0 to stage_2 * k, graph 1 nohead dashtype 3 linecolor rgb "gray70" }
do for [k=1:4] { set arrow from stage_1 * k, graph 0 to stage_1 * k, graph 1 nohead dashtype 2 linecolor rgb "gray30" }
plot data index 1 using 1:2 with lines title "stage 1 (dashed: its mesh frequencies)", \
     data index 1 using 1:3 with lines title "stage 2 (dotted)"
unset multiplot

# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Force of each planet on the carrier:
#     planetary planets.txt && gnuplot -e "data='planets.txt'; picture='planets.png'" planetary.gp
set terminal pngcairo size 1200,600
set output picture
set xlabel "time (s)"
set ylabel "force on the carrier (N)"
set key below
set yrange [0:*]
stats data using 1 nooutput
# Planets at their places carry the same; where they mesh in one phase their lines lie on each other.
plot for [k=0:STATS_columns-2] data using 1:2+k with lines lw 2 dashtype k+1 title sprintf("planet %d%s", k, k == 0 ? ", 5 um off its place" : "")

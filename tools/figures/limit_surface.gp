# Draws sections of the limit surface of the paper's front joint. Variables: data, output.
set terminal svg size 900,480 font "sans,13" background "white"
set output output
set multiplot layout 1,2
set size square
set grid lc rgb "#dddddd"
set key outside bottom center horizontal
set xtics 200
set ytics 200
set xlabel "one force, kN"
set ylabel "couple, kN m"
set xrange [-480:480]
set yrange [-680:680]
plot data."/section_fx_m.dat" using 1:2 with lines lw 2.5 lc rgb "#1f5fa8" title "F_x", \
     data."/section_fy_m.dat" using 1:2 with lines lw 2.5 lc rgb "#c0392b" title "F_y", \
     data."/section_fx_m.dat" using 3:4 with lines lw 1.2 dt 2 lc rgb "#000000" title "ellipse"
set xlabel "F_x, kN"
set ylabel "F_y, kN"
set yrange [-480:480]
plot data."/slices.dat" index 0 with lines lw 2.5 lc rgb "#111111" title "M = 0", \
     data."/slices.dat" index 1 with lines lw 2.5 lc rgb "#1f5fa8" title "0.5 M_0", \
     data."/slices.dat" index 2 with lines lw 2.5 lc rgb "#2c8c4a" title "0.8 M_0", \
     data."/slices.dat" index 3 with lines lw 2.5 lc rgb "#c0392b" title "0.95 M_0"
unset multiplot

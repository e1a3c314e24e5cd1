# Draws a measured record and the fit of models/studies/sliding_block_fit.toml. Variables: data, output.
set terminal svg size 640,360 font "sans,13" background "white"
set output output
set datafile separator ","
set grid lc rgb "#dddddd"
set key right top
set xlabel "t, ms"
set ylabel "slide, mm"
plot data."/fit.csv" skip 1 using ($2*1e3):($3*1e3) with points pt 7 ps 0.35 lc rgb "#8a8f98" title "measured", \
     data."/fit.csv" skip 1 using ($2*1e3):($4*1e3) with lines lw 2.5 lc rgb "#1f5fa8" title "fitted"

%
(Circle of radius 50 mm, once counterclockwise from its top, 200 mm/s)
N10 G21 G17 G90 G61
N20 G3 X0 Y0 I0 J-50 F12000
N30 M30
%

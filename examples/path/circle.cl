PARTNO CIRCLE
$$ Radius 50 mm, once counterclockwise from its top, 200 mm/s.
UNITS/MM
FROM/0,0,0
FEDRAT/12000,MMPM
CIRCLE/0,-50,0,0,0,1,50
GOTO/0,0,0
FINI

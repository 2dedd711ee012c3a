UPDATE rock SET radius = 1e300, var_x = -1;

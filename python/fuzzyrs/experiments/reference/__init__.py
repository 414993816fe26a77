"""The numbers printed in the thesis. `null` is a number that the scan lost."""

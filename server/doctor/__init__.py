"""`agora doctor`: a rig and its machine are looked at (`listening`, `looking`), judged without looking (`*_verdicts`), shown."""

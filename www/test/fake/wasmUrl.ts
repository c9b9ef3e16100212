/** The fake has nothing to compile. */
export default "none";

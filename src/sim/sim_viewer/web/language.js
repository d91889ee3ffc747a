// The page speaks Chinese or English: what was chosen by the switch, else what the address asks for
// (run.html?zh), else the browser's language.

const chosen = localStorage.getItem("language");
const asked = ["?zh", "?en"].includes(location.search) ? location.search.slice(1) : null;

export const language = chosen ?? asked ?? (navigator.language.startsWith("zh") ? "zh" : "en");

/** The text in the page's language. */
export function t(english, chinese) {
  return language === "zh" ? chinese : english;
}

/** Turn to the other language; the page loads anew. */
export function switchLanguage() {
  localStorage.setItem("language", language === "zh" ? "en" : "zh");
  location.reload();
}
